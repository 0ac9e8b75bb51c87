//! How the window looks: a dark and a light palette, one spacing, one set of type sizes.

use std::cell::Cell;

use egui::style::{Selection, TextCursorStyle, WidgetVisuals};
use egui::{Color32, CornerRadius, FontFamily, FontId, Margin, Shadow, Stroke, TextStyle, vec2};
use serde::{Deserialize, Serialize};

/// Which palette the user wants.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Appearance {
    #[default]
    Dark,
    Light,
    /// As the system has it; dark where it does not say.
    System,
}

/// The colours of panels and of what is in them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Palette {
    pub is_light: bool,
    /// Behind everything.
    pub ground: Color32,
    pub panel: Color32,
    /// Lines between panels.
    pub line: Color32,
    /// Wells: canvases, tracks, number fields.
    pub well: Color32,
    /// Buttons and other things to press.
    pub raised: Color32,
    pub raised_hover: Color32,
    pub raised_press: Color32,
    /// What is written.
    pub text: Color32,
    /// What is written on something chosen or under the mouse.
    pub strong: Color32,
    /// Labels beside values.
    pub muted: Color32,
    /// Least important: hints, ticks.
    pub faint: Color32,
    /// What is chosen or in motion.
    pub accent: Color32,
    /// Ground under something chosen.
    pub accent_deep: Color32,
    pub warning: Color32,
    pub error: Color32,
    /// Bars of a histogram, and lines over it.
    pub bar: Color32,
    pub curve: Color32,
    /// Frames on the timeline: being read, and in memory.
    pub loading: Color32,
    pub cached: Color32,
}

/// What lies over the picture has these colours in either appearance: the picture stays what it is.
pub static DARK: Palette = Palette {
    is_light: false,
    ground: Color32::from_rgb(0x11, 0x13, 0x16),
    panel: Color32::from_rgb(0x1a, 0x1d, 0x22),
    line: Color32::from_rgb(0x2b, 0x30, 0x37),
    well: Color32::from_rgb(0x12, 0x14, 0x18),
    raised: Color32::from_rgb(0x2a, 0x2f, 0x37),
    raised_hover: Color32::from_rgb(0x36, 0x3d, 0x47),
    raised_press: Color32::from_rgb(0x42, 0x4b, 0x57),
    text: Color32::from_rgb(0xdf, 0xe3, 0xe8),
    strong: Color32::WHITE,
    muted: Color32::from_rgb(0x9a, 0xa4, 0xb1),
    faint: Color32::from_rgb(0x6c, 0x77, 0x85),
    accent: Color32::from_rgb(0x5f, 0xb8, 0xc4),
    accent_deep: Color32::from_rgb(0x22, 0x4c, 0x55),
    warning: Color32::from_rgb(0xe5, 0xb4, 0x5f),
    error: Color32::from_rgb(0xee, 0x7d, 0x76),
    bar: Color32::from_rgb(0x2d, 0x33, 0x3c),
    curve: Color32::from_rgb(0xd5, 0xda, 0xe1),
    loading: Color32::from_rgb(0x27, 0x38, 0x3f),
    cached: Color32::from_rgb(0x33, 0x5f, 0x69),
};

static LIGHT: Palette = Palette {
    is_light: true,
    ground: Color32::from_rgb(0xd5, 0xd9, 0xde),
    panel: Color32::from_rgb(0xf3, 0xf4, 0xf6),
    line: Color32::from_rgb(0xd2, 0xd7, 0xdd),
    well: Color32::from_rgb(0xff, 0xff, 0xff),
    raised: Color32::from_rgb(0xe2, 0xe6, 0xeb),
    raised_hover: Color32::from_rgb(0xd5, 0xdb, 0xe2),
    raised_press: Color32::from_rgb(0xc3, 0xcb, 0xd5),
    text: Color32::from_rgb(0x1d, 0x22, 0x28),
    strong: Color32::from_rgb(0x08, 0x1d, 0x21),
    muted: Color32::from_rgb(0x54, 0x5e, 0x6a),
    faint: Color32::from_rgb(0x74, 0x7f, 0x8b),
    accent: Color32::from_rgb(0x17, 0x7d, 0x8b),
    accent_deep: Color32::from_rgb(0xad, 0xdc, 0xe3),
    warning: Color32::from_rgb(0x8c, 0x5a, 0x00),
    error: Color32::from_rgb(0xb4, 0x2a, 0x22),
    bar: Color32::from_rgb(0xd3, 0xd9, 0xe0),
    curve: Color32::from_rgb(0x2c, 0x33, 0x3b),
    loading: Color32::from_rgb(0xc4, 0xde, 0xe2),
    cached: Color32::from_rgb(0x86, 0xbf, 0xc8),
};

thread_local! {
    /// Of the window that this thread draws.
    static IS_LIGHT: Cell<bool> = const { Cell::new(false) };
}

/// The colours in force.
pub fn colours() -> &'static Palette {
    if IS_LIGHT.get() { &LIGHT } else { &DARK }
}

/// Gives `context` another look, where the one that is wanted is not the one in force.
pub fn choose(context: &egui::Context, appearance: Appearance) {
    let is_light = match appearance {
        Appearance::Dark => false,
        Appearance::Light => true,
        Appearance::System => context.system_theme() == Some(egui::Theme::Light),
    };
    if is_light != IS_LIGHT.replace(is_light) {
        apply(context);
    }
}

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

/// Gives `context` the look in force.
pub fn apply(context: &egui::Context) {
    context.set_theme(if colours().is_light { egui::Theme::Light } else { egui::Theme::Dark });
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
    let colours = colours();
    visuals.dark_mode = !colours.is_light;
    visuals.weak_text_color = Some(colours.muted);
    visuals.hyperlink_color = colours.accent;
    visuals.faint_bg_color = colours.raised.gamma_multiply(0.4);
    visuals.extreme_bg_color = colours.well;
    visuals.text_edit_bg_color = Some(colours.well);
    visuals.code_bg_color = colours.raised;
    visuals.warn_fg_color = colours.warning;
    visuals.error_fg_color = colours.error;
    visuals.panel_fill = colours.panel;
    visuals.window_fill = colours.panel;
    visuals.window_stroke = Stroke::new(1.0, colours.line);
    visuals.window_corner_radius = CornerRadius::same(8);
    visuals.menu_corner_radius = CornerRadius::same(6);
    visuals.window_shadow = shadow(24);
    visuals.popup_shadow = shadow(12);
    visuals.selection = Selection { bg_fill: colours.accent_deep, stroke: Stroke::new(1.0, colours.text) };
    visuals.text_cursor = TextCursorStyle { stroke: Stroke::new(1.5, colours.accent), ..Default::default() };
    visuals.slider_trailing_fill = true;
    let widgets = &mut visuals.widgets;
    widgets.noninteractive = widget(colours.panel, colours.muted);
    widgets.noninteractive.bg_stroke = Stroke::new(1.0, colours.line);
    widgets.noninteractive.fg_stroke = Stroke::new(1.0, colours.text);
    widgets.inactive = widget(colours.raised, colours.text);
    // Check boxes are small: they need more contrast than buttons do.
    widgets.inactive.bg_fill = colours.raised_press;
    widgets.hovered = widget(colours.raised_hover, colours.strong);
    widgets.active = widget(colours.raised_press, colours.strong);
    widgets.open = widget(colours.raised_hover, colours.text);
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
