//! The cells behind a pixel along depth: what the quantity may be in them, and what they charge.

use egui::{Align2, Color32, Painter, Rect, Sense, Stroke, Ui, pos2, vec2};
use renderer::{Bound, Brick, BundleDetail, CellClass, CellDetail, KnownValues};

use crate::viewer::inspect::probe::Probed;
use crate::viewer::session::Session;
use crate::viewer::{theme, widgets};

use super::cell_classes::colour;
use super::inspector::cumulative;
use super::sampling::plain;
use super::transfer_canvas::to_screen;

/// Heights of the two plots, of the gap between, and of the axis below.
const VALUES: f32 = 138.0;
const CHARGES: f32 = 62.0;
const GAP: f32 = 18.0;
const TITLE: f32 = 16.0;
const AXIS: f32 = 18.0;
/// Room for the labels at the left, and for those at the right.
const LEFT: f32 = 34.0;
const RIGHT: f32 = 6.0;

/// Layers side by side on an axis.
struct Axis {
    first: u32,
    end: u32,
    rect: Rect,
}

impl Axis {
    /// The filled layers of a bundle and its end, with a layer to spare on either side.
    fn new(bundle: &BundleDetail, rect: Rect) -> Axis {
        let first = bundle.cells.first().map_or(0, |cell| cell.cell.layer);
        let last = bundle.cells.last().map_or(0, |cell| cell.cell.layer);
        Axis { first: first.saturating_sub(1), end: (last + 2).min(bundle.layers.max(1)), rect }
    }

    fn step(&self) -> f32 {
        self.rect.width() / (self.end - self.first).max(1) as f32
    }

    /// Where a place between layers is, counted in layers.
    fn x(&self, layer: f32) -> f32 {
        self.rect.left() + (layer - self.first as f32) * self.step()
    }

    fn layer(&self, x: f32) -> u32 {
        self.first + ((x - self.rect.left()) / self.step()).max(0.0) as u32
    }
}

pub fn show(ui: &mut Ui, session: &Session, probed: &Probed, hovered: Option<u32>, now: &mut Option<u32>) {
    // By the paper's bound, no cell has a charge of its own.
    let budget = probed.bundle.budget.filter(|_| probed.bundle.bound == Bound::Difference);
    let below = if budget.is_some() { GAP + CHARGES } else { 0.0 };
    let size = vec2(ui.available_width(), TITLE + VALUES + below + AXIS);
    let (mut rect, response) = ui.allocate_exact_size(size, Sense::hover());
    rect.min.y += TITLE;
    let upper = Rect::from_min_max(
        pos2(rect.left() + LEFT, rect.top()),
        pos2(rect.right() - RIGHT, rect.top() + VALUES),
    );
    let axis = Axis::new(&probed.bundle, upper);
    if let Some(place) = response.hover_pos().filter(|place| upper.x_range().contains(place.x)) {
        let layer = axis.layer(place.x);
        *now = probed.bundle.cells.iter().map(|cell| cell.cell.layer).find(|known| *known == layer);
    }
    let painter = ui.painter();
    painter.rect_filled(upper, 2, theme::colours().well);
    values(painter, session, probed, &axis, hovered);
    let mut bottom = upper.bottom();
    if let Some(budget) = budget {
        let top = rect.top() + VALUES + GAP;
        let lower = Rect::from_min_max(pos2(upper.left(), top), pos2(upper.right(), top + CHARGES));
        painter.rect_filled(lower, 2, theme::colours().well);
        band(painter, &axis, lower, hovered);
        charged(painter, probed, budget, &axis, lower);
        bottom = lower.bottom();
    }
    depths(painter, &probed.bundle, &axis, bottom);
}

/// A light band behind the cell under the mouse.
fn band(painter: &Painter, axis: &Axis, rect: Rect, layer: Option<u32>) {
    if let Some(layer) = layer {
        let left = axis.x(layer as f32);
        let band = Rect::from_x_y_ranges(left..=left + axis.step().max(2.0), rect.y_range());
        painter.rect_filled(band, 0, theme::colours().raised);
    }
}

/// Bounds of u: those of each cell, and those of the pixel's bricks in it.
fn values(painter: &Painter, session: &Session, probed: &Probed, axis: &Axis, hovered: Option<u32>) {
    let rect = axis.rect;
    scale(painter, session, rect);
    band(painter, axis, rect, hovered);
    let bar = |left: f32, right: f32, values: KnownValues, colour: Color32| {
        if let KnownValues::Between { low, high, .. } = values {
            let y =
                |device: f32| rect.bottom() - probed.placement.u(f64::from(device)) as f32 * rect.height();
            let (top, bottom) = (y(high), y(low));
            // Never too thin to be seen.
            let middle = 0.5 * (top + bottom);
            let half = (0.5 * (bottom - top)).max(1.0);
            let place = Rect::from_x_y_ranges(left..=right, middle - half..=middle + half);
            painter.rect_filled(place.intersect(rect), 0, colour);
        }
    };
    for cell in &probed.bundle.cells {
        let left = axis.x(cell.cell.layer as f32);
        let width = axis.step();
        let gap = if width > 6.0 { 0.5 } else { 0.0 };
        let parts = parts(cell, probed.column(), session.view.sampling.super_pixels);
        let faint = if parts.is_empty() { 0.6 } else { 0.28 };
        let whole = colour(cell.cell.class);
        bar(left + gap, left + width - gap, cell.values, whole.gamma_multiply(faint));
        let step = width / parts.len().max(1) as f32;
        for (number, (values, class)) in parts.into_iter().enumerate() {
            let start = left + step * number as f32;
            bar(start, start + step, values, colour(class));
        }
    }
}

/// What is known of a cell from front to back: of the bricks of a column, or by the paper's bound of the
/// cell's slabs; and what became of each.
fn parts(cell: &CellDetail, column: usize, super_pixels: bool) -> Vec<(KnownValues, CellClass)> {
    if let Some(slabs) = &cell.slabs {
        return slabs.iter().map(|values| (*values, cell.cell.class)).collect();
    }
    let Some(bricks) = &cell.bricks else { return Vec::new() };
    let class = |number: usize| brick_class(cell, column, number, super_pixels);
    let part = |(number, brick): (usize, &Brick)| (brick.opacity.values, class(number));
    bricks[column].iter().enumerate().map(part).collect()
}

/// What became of one brick, as the class of a cell of such bricks. With super-pixels, no brick is sampled
/// more coarsely.
fn brick_class(cell: &CellDetail, column: usize, brick: usize, super_pixels: bool) -> CellClass {
    match cell.cell.class {
        class @ (CellClass::Occluded | CellClass::Transparent) => class,
        _ if cell.cell.sampled.contains(column, brick) => CellClass::Full,
        _ if cell.cell.coarse.contains(column, brick) && !super_pixels => CellClass::ZAdaptive(2),
        _ => CellClass::SuperPixel,
    }
}

/// The axis of u, with the colours of the transfer function along it; of the field that decides the opacity,
/// where that is another one, with the opacities in grey.
fn scale(painter: &Painter, session: &Session, rect: Rect) {
    if let Ok(transfer) = session.view.transfer.function() {
        let steps = rect.height() as u32;
        for step in 0..steps {
            let [r, g, b, alpha] = transfer.sample(1.0 - (step as f32 + 0.5) / steps as f32);
            let rgb = if session.opacity_field().is_some() { [alpha; 3] } else { [r, g, b] };
            let y = rect.top() + step as f32;
            let line = Rect::from_x_y_ranges(rect.left() - 7.0..=rect.left() - 2.0, y..=y + 1.0);
            painter.rect_filled(line, 0, to_screen(rgb));
        }
    }
    for (u, text) in [(0.0, "0"), (0.5, "½"), (1.0, "1")] {
        let y = rect.bottom() - u * rect.height();
        painter.hline(rect.x_range(), y, Stroke::new(1.0, theme::colours().line));
        let place = pos2(rect.left() - 12.0, y);
        painter.text(place, Align2::RIGHT_CENTER, text, theme::small_font(), theme::colours().faint);
    }
    let place = rect.left_top() + vec2(0.0, -3.0);
    let what = match session.opacity_field() {
        None => "u, the quantity in its range",
        Some(_) => "u, the opacity's field in its range",
    };
    let text = format!("{what}: bounds in each cell, and in its parts along this pixel");
    painter.text(place, Align2::LEFT_BOTTOM, text, theme::small_font(), theme::colours().muted);
}

/// What is charged to the pixel's rays, added up from front to back, under the budget.
fn charged(painter: &Painter, probed: &Probed, budget: f32, axis: &Axis, rect: Rect) {
    let y = |charge: f32| rect.bottom() - charge / (1.15 * budget) * rect.height();
    painter.hline(rect.x_range(), y(budget), Stroke::new(1.0, theme::colours().warning.gamma_multiply(0.7)));
    let place = pos2(rect.left() - 4.0, y(budget));
    painter.text(place, Align2::RIGHT_CENTER, "E", theme::small_font(), theme::colours().warning);
    let zero = pos2(rect.left() - 12.0, rect.bottom());
    painter.text(zero, Align2::RIGHT_CENTER, "0", theme::small_font(), theme::colours().faint);

    let column = probed.column();
    let sums = cumulative(&probed.bundle.cells, column);
    let mut points = vec![rect.left_bottom()];
    for (cell, sum) in probed.bundle.cells.iter().zip(&sums) {
        let before = points.last().map_or(rect.bottom(), |point| point.y);
        points.push(pos2(axis.x(cell.cell.layer as f32), before));
        points.push(pos2(axis.x(cell.cell.layer as f32 + 1.0), y(*sum)));
    }
    let all = probed.bundle.charged[column];
    let end = axis.x(probed.bundle.end_layer as f32).clamp(rect.left(), rect.right());
    // What lies behind the end of the rays is charged as a whole.
    points.retain(|point| point.x <= end + 0.5);
    let last = points.last().map_or(rect.bottom(), |point| point.y);
    points.extend([pos2(end, last), pos2(end, y(all)), pos2(rect.right(), y(all))]);
    painter.line(points, Stroke::new(1.5, theme::colours().accent));

    let place = rect.left_top() + vec2(0.0, -3.0);
    let text = format!("charged from the front up to here, {} in all; E: the budget", plain(f64::from(all)));
    painter.text(place, Align2::LEFT_BOTTOM, text, theme::small_font(), theme::colours().muted);
}

/// Depths below the plots, and where the rays end.
fn depths(painter: &Painter, bundle: &BundleDetail, axis: &Axis, bottom: f32) {
    let whole = Rect::from_x_y_ranges(axis.rect.x_range(), axis.rect.top()..=bottom);
    if bundle.end_layer < axis.end {
        let x = axis.x(bundle.end_layer as f32);
        painter.extend(egui::Shape::dashed_line(
            &[pos2(x, whole.top()), pos2(x, whole.bottom())],
            Stroke::new(1.0, theme::colours().muted),
            3.0,
            3.0,
        ));
        let align = if x > whole.center().x { Align2::RIGHT_TOP } else { Align2::LEFT_TOP };
        let aside = if x > whole.center().x { -4.0 } else { 4.0 };
        let place = pos2(x + aside, whole.top() + 18.0);
        let text = "the rays end".to_owned();
        let galley = painter.layout_no_wrap(text, theme::small_font(), theme::colours().text);
        let area = align.anchor_size(place, galley.size());
        painter.rect_filled(area.expand2(vec2(3.0, 1.0)), 2, theme::colours().panel);
        painter.galley(area.min, galley, theme::colours().text);
    }
    let (Some(first), Some(last)) = (bundle.cells.first(), bundle.cells.last()) else { return };
    let ends = [
        (axis.x(first.cell.layer as f32), first.depths[0], Align2::LEFT_TOP),
        (axis.x(last.cell.layer as f32 + 1.0), last.depths[1], Align2::RIGHT_TOP),
    ];
    for (x, depth, align) in ends {
        let place = pos2(x, bottom + 3.0);
        painter.text(place, align, widgets::short(depth), theme::number_font(), theme::colours().muted);
    }
    let place = pos2(whole.center().x, bottom + 3.0);
    painter.text(place, Align2::CENTER_TOP, "view depth", theme::small_font(), theme::colours().faint);
}
