//! How the window looks: one dark palette, one spacing, one set of type sizes.

use egui::style::{Selection, TextCursorStyle, WidgetVisuals};
use egui::{Color32, CornerRadius, FontFamily, FontId, Margin, Shadow, Stroke, TextStyle, vec2};

/// Behind everything.
pub const GROUND: Color32 = Color32::from_rgb(0x11, 0x13, 0x16);
/// Panels.
pub const PANEL: Color32 = Color32::from_rgb(0x1a, 0x1d, 0x22);
/// Lines between panels.
pub const LINE: Color32 = Color32::from_rgb(0x2b, 0x30, 0x37);
/// Wells: canvases, tracks, number fields.
pub const WELL: Color32 = Color32::from_rgb(0x12, 0x14, 0x18);
/// Buttons and other things to press.
pub const RAISED: Color32 = Color32::from_rgb(0x2a, 0x2f, 0x37);
pub const RAISED_HOVER: Color32 = Color32::from_rgb(0x36, 0x3d, 0x47);
pub const RAISED_PRESS: Color32 = Color32::from_rgb(0x42, 0x4b, 0x57);
/// What is written.
pub const TEXT: Color32 = Color32::from_rgb(0xdf, 0xe3, 0xe8);
/// Labels beside values.
pub const MUTED: Color32 = Color32::from_rgb(0x9a, 0xa4, 0xb1);
/// Least important: hints, ticks.
pub const FAINT: Color32 = Color32::from_rgb(0x6c, 0x77, 0x85);
/// What is chosen or in motion.
pub const ACCENT: Color32 = Color32::from_rgb(0x5f, 0xb8, 0xc4);
/// Ground under something chosen.
pub const ACCENT_DEEP: Color32 = Color32::from_rgb(0x22, 0x4c, 0x55);
pub const WARNING: Color32 = Color32::from_rgb(0xe5, 0xb4, 0x5f);
pub const ERROR: Color32 = Color32::from_rgb(0xee, 0x7d, 0x76);

/// Sizes in points.
pub const SIDE_WIDTH: f32 = 320.0;
pub const LABEL_WIDTH: f32 = 96.0;
pub const ROW_HEIGHT: f32 = 24.0;
/// Number fields stand under one another.
pub const FIELD_WIDTH: f32 = 76.0;
pub const GAP: f32 = 6.0;
pub const MARGIN: i8 = 14;
const ROUNDING: CornerRadius = CornerRadius::same(4);

/// Type of numbers that stand under one another.
pub fn number_font() -> FontId {
    FontId::new(12.0, FontFamily::Monospace)
}

pub fn small_font() -> FontId {
    FontId::new(11.5, FontFamily::Proportional)
}

/// Gives `context` this look.
pub fn apply(context: &egui::Context) {
    context.set_theme(egui::Theme::Dark);
    context.all_styles_mut(|style| {
        style.text_styles = [
            (TextStyle::Heading, FontId::new(15.0, FontFamily::Proportional)),
            (TextStyle::Body, FontId::new(13.5, FontFamily::Proportional)),
            (TextStyle::Button, FontId::new(13.5, FontFamily::Proportional)),
            (TextStyle::Monospace, number_font()),
            (TextStyle::Small, small_font()),
        ]
        .into();
        style.drag_value_text_style = TextStyle::Monospace;
        style.animation_time = 0.08;
        style.explanation_tooltips = false;
        spacing(&mut style.spacing);
        visuals(&mut style.visuals);
    });
}

fn spacing(spacing: &mut egui::style::Spacing) {
    spacing.item_spacing = vec2(GAP, GAP);
    spacing.button_padding = vec2(9.0, 3.0);
    spacing.interact_size = vec2(FIELD_WIDTH, ROW_HEIGHT);
    spacing.window_margin = Margin::same(16);
    spacing.menu_margin = Margin::same(6);
    spacing.combo_width = 0.0;
    spacing.combo_height = 320.0;
    spacing.icon_width = 16.0;
    spacing.icon_width_inner = 9.0;
    spacing.icon_spacing = 7.0;
    spacing.tooltip_width = 320.0;
    spacing.scroll = egui::style::ScrollStyle::thin();
}

fn visuals(visuals: &mut egui::Visuals) {
    visuals.dark_mode = true;
    visuals.weak_text_color = Some(MUTED);
    visuals.hyperlink_color = ACCENT;
    visuals.faint_bg_color = Color32::from_rgb(0x1e, 0x22, 0x27);
    visuals.extreme_bg_color = WELL;
    visuals.text_edit_bg_color = Some(WELL);
    visuals.code_bg_color = RAISED;
    visuals.warn_fg_color = WARNING;
    visuals.error_fg_color = ERROR;
    visuals.panel_fill = PANEL;
    visuals.window_fill = PANEL;
    visuals.window_stroke = Stroke::new(1.0, LINE);
    visuals.window_corner_radius = CornerRadius::same(8);
    visuals.menu_corner_radius = CornerRadius::same(6);
    visuals.window_shadow = shadow(24);
    visuals.popup_shadow = shadow(12);
    visuals.selection = Selection { bg_fill: ACCENT_DEEP, stroke: Stroke::new(1.0, TEXT) };
    visuals.text_cursor = TextCursorStyle { stroke: Stroke::new(1.5, ACCENT), ..Default::default() };
    visuals.slider_trailing_fill = true;
    let widgets = &mut visuals.widgets;
    widgets.noninteractive = widget(PANEL, MUTED);
    widgets.noninteractive.bg_stroke = Stroke::new(1.0, LINE);
    widgets.noninteractive.fg_stroke = Stroke::new(1.0, TEXT);
    widgets.inactive = widget(RAISED, TEXT);
    // Check boxes are small: they need more contrast than buttons do.
    widgets.inactive.bg_fill = RAISED_PRESS;
    widgets.hovered = widget(RAISED_HOVER, Color32::WHITE);
    widgets.active = widget(RAISED_PRESS, Color32::WHITE);
    widgets.open = widget(RAISED_HOVER, TEXT);
}

fn widget(fill: Color32, text: Color32) -> WidgetVisuals {
    WidgetVisuals {
        bg_fill: fill,
        weak_bg_fill: fill,
        bg_stroke: Stroke::NONE,
        corner_radius: ROUNDING,
        fg_stroke: Stroke::new(1.2, text),
        expansion: 0.0,
    }
}

fn shadow(blur: u8) -> Shadow {
    Shadow { offset: [0, 4], blur, spread: 0, color: Color32::from_black_alpha(120) }
}
