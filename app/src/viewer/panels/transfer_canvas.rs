//! The canvas of the transfer-function editor: where a control point lies, and how it is moved.

use egui::epaint::Mesh;
use egui::{Color32, Painter, Pos2, Rect, Rgba, Shape, Stroke, StrokeKind, pos2};
use renderer::{ColourPoint, ControlPoint, TransferView};

use crate::viewer::theme;

use super::transfer_edit::colour_nodes;
use super::transfer_fields::Node;

/// Where a logarithmic axis goes over to a linear one, which ends at zero: the opacity, and its share of the
/// axis.
const LOG_FLOOR: f32 = 1e-4;
const LINEAR: f32 = 0.08;
/// A node is caught within this distance, in points.
const REACH: f32 = 9.0;
/// Points between two columns of a gradient.
const COLUMN: f32 = 2.0;

/// From u and opacity to the screen and back.
#[derive(Clone, Copy, Debug)]
pub struct Axes {
    pub rect: Rect,
    /// Whether the opacity axis is logarithmic.
    pub log: bool,
}

impl Axes {
    pub fn x(&self, u: f32) -> f32 {
        self.rect.left() + u * self.rect.width()
    }

    pub fn y(&self, opacity: f32) -> f32 {
        let height = match self.log {
            true if opacity < LOG_FLOOR => LINEAR * opacity / LOG_FLOOR,
            true => 1.0 - (1.0 - LINEAR) * opacity.log10() / LOG_FLOOR.log10(),
            false => opacity,
        };
        self.rect.bottom() - height * self.rect.height()
    }

    pub fn place(&self, point: &ControlPoint) -> Pos2 {
        pos2(self.x(point.u), self.y(point.opacity))
    }

    /// u and opacity at a place, clamped to the canvas.
    pub fn at(&self, place: Pos2) -> (f32, f32) {
        let u = ((place.x - self.rect.left()) / self.rect.width()).clamp(0.0, 1.0);
        let height = ((self.rect.bottom() - place.y) / self.rect.height()).clamp(0.0, 1.0);
        let opacity = match self.log {
            true if height < LINEAR => LOG_FLOOR * height / LINEAR,
            true => LOG_FLOOR.powf((1.0 - height) / (1.0 - LINEAR)),
            false => height,
        };
        (u, opacity)
    }

    /// The node under the cursor, the nearest where there are several.
    pub fn hit(&self, points: &[ControlPoint], cursor: Pos2) -> Option<usize> {
        let distance = |index: &usize| self.place(&points[*index]).distance(cursor);
        let near = (0..points.len()).filter(|index| distance(index) <= REACH);
        near.min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }
}

/// The colours below the canvas, and their nodes.
#[derive(Clone, Copy, Debug)]
pub struct Strip {
    pub rect: Rect,
    /// Height of the nodes' middles on the screen.
    pub nodes: f32,
}

impl Strip {
    /// Whether a place belongs to the strip rather than to the canvas.
    pub fn holds(&self, place: Pos2) -> bool {
        place.y >= self.rect.top() - 1.0
    }

    pub fn place(&self, u: f32) -> Pos2 {
        pos2(self.rect.left() + u * self.rect.width(), self.nodes)
    }

    /// The node at the cursor, the nearest where there are several.
    pub fn hit(&self, nodes: &[ColourPoint], cursor: Pos2) -> Option<usize> {
        let distance = |index: &usize| (self.place(nodes[*index].u).x - cursor.x).abs();
        let near = (0..nodes.len()).filter(|index| distance(index) <= 0.8 * REACH);
        near.min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }
}

/// What lies behind the nodes.
pub struct Behind {
    /// u of the edges of the histogram's bars, one more than there are bars.
    pub edges: Vec<f32>,
    pub bars: Vec<u64>,
    /// Whether counts are shown in proportion, rather than by their logarithms.
    pub plain_counts: bool,
    /// Whether opacities are of another field than the colours, so that none of these is that of a node.
    pub colourless: bool,
}

/// A canvas with the histogram behind the opacity, and the colours in a strip below.
pub fn paint(painter: &Painter, axes: &Axes, strip: &Strip, transfer: &TransferView, behind: &Behind) {
    let frame = axes.rect.expand2(egui::vec2(7.0, 7.0));
    painter.rect_filled(frame, 4, theme::colours().well);
    histogram(painter, axes, behind);
    grid(painter, axes);
    let Ok(function) = transfer.function() else { return };
    gradient(painter, axes.rect, |u| {
        let [r, g, b, opacity] = function.sample(u);
        let fill = match behind.colourless {
            true => theme::colours().accent.gamma_multiply(0.25),
            false => to_screen([r, g, b]).gamma_multiply(0.45),
        };
        (axes.y(opacity), fill)
    });
    gradient(painter, strip.rect, |u| {
        let [r, g, b, _] = function.sample(u);
        (strip.rect.top(), to_screen([r, g, b]))
    });
    outline(painter, axes, &transfer.points);
    painter.rect_stroke(strip.rect, 2, Stroke::new(1.0, theme::colours().line), StrokeKind::Outside);
}

/// The nodes, on top of everything. `marked`: the one that is selected, and the one under the cursor.
pub fn paint_nodes(
    painter: &Painter,
    axes: &Axes,
    strip: &Strip,
    transfer: &TransferView,
    behind: &Behind,
    marked: [Option<Node>; 2],
) {
    let ring = |node: Node, small: f32| {
        let [chosen, under] = marked.map(|marked| marked == Some(node));
        let radius = if chosen || under { small + 1.0 } else { small };
        let ring = if chosen { theme::colours().strong } else { theme::colours().muted };
        (radius, Stroke::new(if chosen { 2.0 } else { 1.3 }, ring))
    };
    for (index, node) in colour_nodes(transfer).unwrap_or_default().into_iter().enumerate() {
        let (radius, stroke) = ring(Node::Colour(index), 3.8);
        let place = strip.place(node.u);
        let tip = pos2(place.x, strip.rect.bottom() - 1.0);
        painter.line_segment([tip, place], Stroke::new(1.0, stroke.color));
        painter.circle(place, radius, to_screen(node.rgb), stroke);
    }
    let function = transfer.function().ok();
    for (index, point) in transfer.points.iter().enumerate() {
        let [r, g, b, _] = function.as_ref().map_or([1.0; 4], |function| function.sample(point.u));
        let (radius, stroke) = ring(Node::Opacity(index), 5.0);
        let colour = if behind.colourless { theme::colours().raised } else { to_screen([r, g, b]) };
        painter.circle(axes.place(point), radius, colour, stroke);
    }
}

/// Particles in each bar, in proportion or by logarithms: then rare values are seen as well as common ones.
fn histogram(painter: &Painter, axes: &Axes, behind: &Behind) {
    let most = behind.bars.iter().copied().max().unwrap_or(0);
    if most == 0 {
        return;
    }
    let size = |bar: u64| if behind.plain_counts { bar as f32 } else { (1.0 + bar as f32).ln() };
    let mut mesh = Mesh::default();
    for (bar, edges) in behind.bars.iter().zip(behind.edges.windows(2)) {
        let height = size(*bar) / size(most) * axes.rect.height();
        let corner = pos2(axes.x(edges[0]), axes.rect.bottom() - height);
        let bar = Rect::from_min_max(corner, pos2(axes.x(edges[1]), axes.rect.bottom()));
        mesh.add_colored_rect(bar, theme::colours().bar);
    }
    painter.add(Shape::mesh(mesh));
}

fn grid(painter: &Painter, axes: &Axes) {
    let steps: &[f32] = if axes.log { &[1.0, 0.1, 0.01, 0.001, LOG_FLOOR] } else { &[1.0, 0.75, 0.5, 0.25] };
    let stroke = Stroke::new(1.0, theme::colours().line.gamma_multiply(0.5));
    for &opacity in steps {
        painter.hline(axes.rect.x_range(), axes.y(opacity), stroke);
        let place = pos2(axes.rect.right() - 2.0, axes.y(opacity) + 1.0);
        let font = egui::FontId::monospace(9.5);
        let text = format!("{opacity}");
        painter.text(place, egui::Align2::RIGHT_TOP, text, font, theme::colours().faint);
    }
    painter.hline(axes.rect.x_range(), axes.rect.bottom(), Stroke::new(1.0, theme::colours().line));
}

/// Columns from the bottom of `rect` up to a height, each in its colour.
pub fn gradient(painter: &Painter, rect: Rect, at: impl Fn(f32) -> (f32, Color32)) {
    let columns = (rect.width() / COLUMN).ceil().max(1.0) as u32;
    let mut mesh = Mesh::default();
    for column in 0..=columns {
        let u = column as f32 / columns as f32;
        let x = rect.left() + u * rect.width();
        let (top, colour) = at(u);
        mesh.colored_vertex(pos2(x, top), colour);
        mesh.colored_vertex(pos2(x, rect.bottom()), colour);
        if column > 0 {
            let next = 2 * column;
            mesh.add_triangle(next - 2, next - 1, next);
            mesh.add_triangle(next - 1, next, next + 1);
        }
    }
    painter.add(Shape::mesh(mesh));
}

/// The opacity as a line: through the nodes, level outside.
fn outline(painter: &Painter, axes: &Axes, points: &[ControlPoint]) {
    let (Some(first), Some(last)) = (points.first(), points.last()) else { return };
    let mut line = vec![pos2(axes.rect.left(), axes.y(first.opacity)), axes.place(first)];
    for pair in points.windows(2) {
        // On a logarithmic axis, a straight ramp is a curve.
        let parts = if axes.log { 64 } else { 1 };
        line.extend((1..=parts).map(|part| {
            let s = part as f32 / parts as f32;
            let u = pair[0].u + s * (pair[1].u - pair[0].u);
            let opacity = pair[0].opacity + s * (pair[1].opacity - pair[0].opacity);
            pos2(axes.x(u), axes.y(opacity))
        }));
    }
    line.push(pos2(axes.rect.right(), axes.y(last.opacity)));
    painter.line(line, Stroke::new(1.6, theme::colours().curve));
}

/// A linear colour as the screen's.
pub fn to_screen([r, g, b]: [f32; 3]) -> Color32 {
    Rgba::from_rgb(r, g, b).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axes(log: bool) -> Axes {
        Axes { rect: Rect::from_min_max(pos2(10.0, 20.0), pos2(210.0, 120.0)), log }
    }

    fn point(u: f32, opacity: f32) -> ControlPoint {
        ControlPoint { u, rgb: [0.5; 3], opacity }
    }

    #[test]
    fn places_go_there_and_back() {
        for log in [false, true] {
            for (u, opacity) in [(0.0, 0.0), (0.3, 0.02), (1.0, 1.0)] {
                let (back_u, back) = axes(log).at(axes(log).place(&point(u, opacity)));
                assert!((back_u - u).abs() < 1e-5 && (back - opacity).abs() < 1e-4, "{u} {opacity} {log}");
            }
        }
        for opacity in [0.0, 2e-6, 9e-5, 1e-4, 3e-4] {
            let (_, back) = axes(true).at(axes(true).place(&point(0.5, opacity)));
            assert!((back - opacity).abs() <= 1e-3 * opacity, "{opacity} near zero is {back}");
        }
        assert_eq!(axes(false).at(pos2(-500.0, 999.0)), (0.0, 0.0));
    }

    #[test]
    fn the_nearest_node_is_caught() {
        let points = [point(0.5, 0.5), point(0.52, 0.5), point(0.9, 0.1)];
        let axes = axes(false);
        assert_eq!(axes.hit(&points, axes.place(&points[1])), Some(1));
        assert_eq!(axes.hit(&points, pos2(10.0, 20.0)), None);
        let strip = Strip { rect: Rect::from_min_max(pos2(10.0, 130.0), pos2(210.0, 142.0)), nodes: 148.0 };
        let nodes = [0.5, 0.52].map(|u| ColourPoint { u, rgb: [0.0; 3] });
        assert_eq!(strip.hit(&nodes, pos2(115.0, 140.0)), Some(1));
        assert_eq!(strip.hit(&nodes, pos2(60.0, 140.0)), None);
        assert!(strip.holds(pos2(60.0, 140.0)) && !strip.holds(pos2(60.0, 100.0)));
    }
}
