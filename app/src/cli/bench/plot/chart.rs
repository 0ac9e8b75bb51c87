//! A chart as SVG: axes with a light grid, what is drawn between them, and labels at the right.

use std::fmt::Write;

use super::axis::Axis;

const SIZE: [f64; 2] = [860.0, 472.0];
/// Places of the ends of the axes; the rest is for titles and labels.
pub const X_ENDS: [f64; 2] = [76.0, 640.0];
pub const Y_ENDS: [f64; 2] = [386.0, 92.0];
const NOTE: &str = r##"fill="#666""##;
const NOTE_SMALL: &str = r##"fill="#666" font-size="11""##;
/// From one label to the next, at least.
const LINE: f64 = 17.0;
/// Characters of a line of the footer: so many fit with a wide font, too.
const FOOTER_WIDTH: usize = 110;

/// How something is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Style {
    pub colour: &'static str,
    /// Pattern of dashes; empty for a solid line. What is dashed has hollow dots.
    pub dashes: &'static str,
}

pub struct Chart {
    x: Axis,
    y: Axis,
    body: String,
    labels: Vec<Label>,
}

struct Label {
    y: f64,
    text: String,
    style: Style,
    key: Key,
}

/// What leads from a label to what it names.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Key {
    /// A stroke to the end of a line.
    Stroke,
    /// A dot of the same looks.
    Dot,
}

impl Chart {
    pub fn new([title, note, footer]: [&str; 3], x: Axis, y: Axis) -> Chart {
        let mut chart = Chart { x, y, body: String::new(), labels: Vec::new() };
        let left = X_ENDS[0];
        chart.text([left, 28.0], r##"font-size="17" font-weight="bold" fill="#111""##, title);
        chart.text([left, 49.0], NOTE, note);
        for (place, line) in footer_lines(footer).iter().enumerate() {
            chart.text([left, 448.0 + 15.0 * place as f64], NOTE_SMALL, line);
        }
        chart.axes();
        chart
    }

    fn axes(&mut self) {
        let ([left, right], [bottom, top]) = (X_ENDS, Y_ENDS);
        for (value, label) in self.y.marks() {
            let y = self.y.place(value);
            self.stroke([[left, y], [right, y]], r##"stroke="#e4e4e4""##);
            self.text([left - 9.0, y + 4.0], r#"text-anchor="end""#, &label);
        }
        for (value, label) in self.x.marks() {
            let x = self.x.place(value);
            self.stroke([[x, bottom], [x, bottom + 5.0]], r##"stroke="#888""##);
            self.text([x, bottom + 20.0], r#"text-anchor="middle""#, &label);
        }
        self.stroke([[left, bottom], [right, bottom]], r##"stroke="#888""##);
        self.text([(left + right) / 2.0, bottom + 40.0], r#"text-anchor="middle""#, self.x.title);
        // Not turned upright: text is read faster as it stands.
        self.text([left, top - 14.0], "", self.y.title);
    }

    /// Through `points`, in units of the axes, with a dot at each where `dots`.
    pub fn line(&mut self, points: &[[f64; 2]], style: Style, dots: bool) {
        let places: Vec<String> = points.iter().map(|&[x, y]| self.at(x, y)).collect();
        let (places, how) = (places.join(" "), stroke(style, 1.8));
        let _ =
            writeln!(self.body, r#"<polyline points="{places}" fill="none" {how} stroke-linejoin="round"/>"#);
        for &point in points.iter().filter(|_| dots) {
            self.dot(point, 2.6, style);
        }
    }

    pub fn dot(&mut self, [x, y]: [f64; 2], radius: f64, style: Style) {
        self.circle([self.x.place(x), self.y.place(y)], radius, style);
    }

    /// A thin line between two points; dotted for a limit, solid for a spread.
    pub fn thin(&mut self, from: [f64; 2], to: [f64; 2], colour: &'static str, dotted: bool) {
        let places = [from, to].map(|[x, y]| [self.x.place(x), self.y.place(y)]);
        let dashes = if dotted { "1.5 3.5" } else { "" };
        self.stroke(places, &stroke(Style { colour, dashes }, 1.3));
    }

    /// A short upright line: where something ends.
    pub fn tick(&mut self, [x, y]: [f64; 2], colour: &str) {
        let [x, y] = [self.x.place(x), self.y.place(y)];
        self.stroke([[x, y - 7.0], [x, y + 7.0]], &format!(r#"stroke="{colour}" stroke-width="1.6""#));
    }

    /// Names, at the right, what stands at the height of `y`.
    pub fn label(&mut self, y: f64, text: &str, style: Style, key: Key) {
        self.labels.push(Label { y: self.y.place(y), text: text.to_owned(), style, key });
    }

    /// The whole file.
    pub fn svg(mut self) -> String {
        self.place_labels();
        let [width, height] = SIZE;
        format!(
            r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" font-family="Helvetica, Arial, 'DejaVu Sans', sans-serif" font-size="13" fill="#333">
<rect width="{width}" height="{height}" fill="white"/>
{}</svg>
"##,
            self.body
        )
    }

    /// Labels keep the order of what they name, and their distance from each other.
    fn place_labels(&mut self) {
        let mut labels = std::mem::take(&mut self.labels);
        labels.sort_by(|a, b| a.y.total_cmp(&b.y));
        let mut heights: Vec<f64> = labels.iter().map(|label| label.y).collect();
        let room = (Y_ENDS[0] - Y_ENDS[1]) / labels.len().max(1) as f64;
        push_apart(&mut heights, LINE.min(room));
        let left = X_ENDS[1];
        for (Label { y, text, style, key }, height) in labels.into_iter().zip(heights) {
            match key {
                Key::Stroke => self.stroke([[left + 4.0, y], [left + 22.0, height]], &stroke(style, 1.3)),
                Key::Dot => self.circle([left + 17.0, height], 4.0, style),
            }
            self.text([left + 28.0, height + 4.5], &format!(r#"fill="{}""#, style.colour), &text);
        }
    }

    fn at(&self, x: f64, y: f64) -> String {
        format!("{:.1},{:.1}", self.x.place(x), self.y.place(y))
    }

    fn circle(&mut self, [x, y]: [f64; 2], radius: f64, Style { colour, dashes }: Style) {
        let fill = if dashes.is_empty() { colour } else { "white" };
        let _ = writeln!(
            self.body,
            r#"<circle cx="{x:.1}" cy="{y:.1}" r="{radius}" fill="{fill}" stroke="{colour}" stroke-width="1.6"/>"#
        );
    }

    fn stroke(&mut self, [[x1, y1], [x2, y2]]: [[f64; 2]; 2], how: &str) {
        let _ = writeln!(self.body, r#"<line x1="{x1:.1}" y1="{y1:.1}" x2="{x2:.1}" y2="{y2:.1}" {how}/>"#);
    }

    fn text(&mut self, [x, y]: [f64; 2], how: &str, text: &str) {
        let text = text.replace('&', "&amp;").replace('<', "&lt;");
        let _ = writeln!(self.body, r#"<text x="{x:.1}" y="{y:.1}" {how}>{text}</text>"#);
    }
}

/// The attributes of a line.
fn stroke(Style { colour, dashes }: Style, width: f64) -> String {
    let dashes = if dashes.is_empty() { String::new() } else { format!(r#" stroke-dasharray="{dashes}""#) };
    format!(r#"stroke="{colour}" stroke-width="{width}"{dashes}"#)
}

/// Moves ascending `places` so far that each two are `distance` apart, groups of them to both sides
/// alike, and none beyond the axis.
fn push_apart(places: &mut [f64], distance: f64) {
    // Of each group: the sum of where its members would have the first one, and how many they are.
    let mut groups: Vec<(f64, usize)> = Vec::new();
    for &place in places.iter() {
        let mut group = (place, 1);
        while let Some(&(sum, count)) = groups.last() {
            let (first, length) = (sum / count as f64, count as f64 * distance);
            if group.0 / group.1 as f64 >= first + length {
                break;
            }
            groups.pop();
            group = (sum + group.0 - group.1 as f64 * length, count + group.1);
        }
        groups.push(group);
    }
    let spread = groups.iter().flat_map(|&(sum, count)| {
        (0..count).map(move |member| sum / count as f64 + member as f64 * distance)
    });
    let [bottom, top] = Y_ENDS;
    let count = places.len();
    for (index, (place, new)) in places.iter_mut().zip(spread).enumerate() {
        let [above, below] = [index, count - 1 - index].map(|others| others as f64 * distance);
        *place = new.min(bottom - below).max(top + above);
    }
}

/// The parts of a footer, which semicolons separate, in lines that fit.
fn footer_lines(footer: &str) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for part in footer.split("; ") {
        match lines.last_mut() {
            Some(line) if line.chars().count() + part.chars().count() + 2 <= FOOTER_WIDTH => {
                line.push_str("; ");
                line.push_str(part);
            }
            _ => lines.push(part.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_footer_goes_on_in_a_second_line() {
        let footer = format!("{}; frames: 8; rounds: 2; {}", "a".repeat(60), "b".repeat(40));
        let expected = [format!("{}; frames: 8; rounds: 2", "a".repeat(60)), "b".repeat(40)];
        assert_eq!(footer_lines(&footer), expected);
        assert_eq!(footer_lines("short; and simple"), ["short; and simple"]);
    }

    #[test]
    fn labels_are_pushed_apart_no_farther_than_they_must() {
        let pushed = |mut places: Vec<f64>| {
            push_apart(&mut places, 10.0);
            places
        };
        assert_eq!(pushed(vec![200.0, 250.0]), [200.0, 250.0]);
        assert_eq!(pushed(vec![220.0, 220.0]), [215.0, 225.0]);
        assert_eq!(pushed(vec![220.0, 220.0, 226.0, 300.0]), [212.0, 222.0, 232.0, 300.0]);
        let [bottom, top] = Y_ENDS;
        assert_eq!(pushed(vec![bottom, bottom]), [bottom - 10.0, bottom]);
        assert_eq!(pushed(vec![top, top]), [top, top + 10.0]);
    }
}
