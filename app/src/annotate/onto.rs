//! Annotations over a finished picture, as it is written to a file.

use crate::image_file::{Format, Pixels, to_linear, to_srgb};

use super::drawing::Drawing;
use super::raster::raster;

/// Lays a drawing over a picture that is to be written in `format`. Pixels that it does not touch stay as
/// they are, bit for bit.
///
/// They mix with a PNG as they do on the screen: in sRGB, over `background` (linear) where there is one,
/// and with straight alpha where there is none. With an EXR, which is premultiplied and linear and has no
/// background, they mix in linear light.
pub fn lay(pixels: &mut Pixels, drawing: &Drawing, background: Option<[f32; 3]>, format: Format) {
    let size = [pixels.width as usize, pixels.height as usize];
    lay_on_rows(&mut pixels.data, 0, size, drawing, background, format);
}

/// The same over the rows from `first_row` on of a picture of `size`.
pub fn lay_on_rows(
    rows: &mut [[f32; 4]],
    first_row: usize,
    size: [usize; 2],
    drawing: &Drawing,
    background: Option<[f32; 3]>,
    format: Format,
) {
    raster(drawing, size, |[x, y], colour, opacity| {
        let place = y.checked_sub(first_row).map(|row| row * size[0] + x);
        let Some(pixel) = place.and_then(|place| rows.get_mut(place)) else { return };
        let colour = colour.map(|byte| f32::from(byte) / 255.0);
        *pixel = match (format, background) {
            (Format::Exr, _) => over_linear(*pixel, colour, opacity),
            (Format::Png, Some(behind)) => over_opaque(*pixel, behind, colour, opacity),
            (Format::Png, None) => over_straight(*pixel, colour, opacity),
        };
    });
}

/// An sRGB colour over a premultiplied linear pixel.
fn over_linear([r, g, b, alpha]: [f32; 4], colour: [f32; 3], opacity: f32) -> [f32; 4] {
    let [cr, cg, cb] = colour.map(to_linear);
    let over = |below: f32, above: f32| opacity * above + (1.0 - opacity) * below;
    [over(r, cr), over(g, cg), over(b, cb), over(alpha, 1.0)]
}

/// The same mixed as on a screen, on which the pixel lies over `behind`.
fn over_opaque([r, g, b, alpha]: [f32; 4], behind: [f32; 3], colour: [f32; 3], opacity: f32) -> [f32; 4] {
    let alpha = alpha.clamp(0.0, 1.0);
    let [r, g, b] = std::array::from_fn(|c| {
        let below = to_srgb(([r, g, b][c] + (1.0 - alpha) * behind[c]).clamp(0.0, 1.0));
        to_linear(opacity * colour[c] + (1.0 - opacity) * below)
    });
    [r, g, b, 1.0]
}

/// The same for a pixel with straight alpha in sRGB: colours count by what they cover.
fn over_straight([r, g, b, alpha]: [f32; 4], colour: [f32; 3], opacity: f32) -> [f32; 4] {
    let alpha = alpha.clamp(0.0, 1.0);
    let below = (1.0 - opacity) * alpha;
    let whole = opacity + below;
    let [r, g, b] = std::array::from_fn(|c| {
        let straight = if alpha > 0.0 { to_srgb(([r, g, b][c] / alpha).clamp(0.0, 1.0)) } else { 0.0 };
        whole * to_linear((opacity * colour[c] + below * straight) / whole)
    });
    [r, g, b, whole]
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use renderer::{AnnotationsView, CameraView, TransferFunction, View};

    use super::*;
    use crate::annotate::{OpacityAxis, Subject, drawing};
    use crate::image_file::to_srgb8;
    use crate::projection::Projection;

    const SIZE: [u32; 2] = [320, 240];

    fn drawn(
        look: &AnnotationsView,
        pixel: [f32; 4],
        background: Option<[f32; 3]>,
        format: Format,
    ) -> Pixels {
        drawn_by(look, background, |drawing| {
            let [width, height] = SIZE;
            let mut pixels = Pixels { width, height, data: vec![pixel; (width * height) as usize] };
            lay(&mut pixels, drawing, background, format);
            pixels
        })
    }

    fn drawn_by(
        look: &AnnotationsView,
        background: Option<[f32; 3]>,
        lay: impl FnOnce(&Drawing) -> Pixels,
    ) -> Pixels {
        let transfer = TransferFunction::new(&View::default().transfer.points).unwrap();
        let camera = CameraView {
            eye: DVec3::new(0.0, 0.0, 5.0),
            target: DVec3::ZERO,
            up: DVec3::Y,
            fov_y_degrees: 45.0,
            near: None,
            far: None,
        };
        let subject = Subject {
            scale: renderer::Scale::Linear,
            opacity: Some(OpacityAxis {
                name: "speed".into(),
                range: [0.01, 10.0],
                scale: renderer::Scale::Log,
            }),
            quantity: Some("density".into()),
            range: Some([0.0, 1.0]),
            transfer: &transfer,
            time: Some(0.25),
            frame: 7,
            projection: Projection::new(&camera, SIZE.map(f64::from)),
            target_depth: 5.0,
            background,
        };
        lay(&drawing(look, &subject))
    }

    #[test]
    fn bands_of_rows_are_drawn_over_as_the_whole_is() {
        let ([width, height], pixel) = (SIZE, [0.2, 0.1, 0.0, 0.5]);
        let in_bands = drawn_by(&all(), None, |drawing| {
            let mut data = vec![pixel; (width * height) as usize];
            for (band, rows) in data.chunks_mut((width * 48) as usize).enumerate() {
                let size = SIZE.map(|side| side as usize);
                lay_on_rows(rows, 48 * band, size, drawing, None, Format::Exr);
            }
            Pixels { width, height, data }
        });
        assert!(in_bands == drawn(&all(), pixel, None, Format::Exr));
        assert!(in_bands.data.iter().any(|drawn| *drawn != pixel));
    }

    /// The bytes of a PNG.
    fn bytes(pixels: &Pixels, background: Option<[f32; 3]>) -> Vec<[u8; 4]> {
        pixels.data.iter().map(|pixel| to_srgb8(*pixel, background)).collect()
    }

    fn all() -> AnnotationsView {
        AnnotationsView {
            time: true,
            frame_number: true,
            scale_bar: true,
            title: "Title".into(),
            ..AnnotationsView::of_window()
        }
    }

    #[test]
    fn what_is_not_asked_for_is_not_drawn() {
        let nothing = AnnotationsView::default();
        let pixel = [0.1, 0.2, 0.05, 0.3];
        assert!(drawn(&nothing, pixel, None, Format::Exr).data.iter().all(|drawn| *drawn == pixel));
        // And where all is asked for, most pixels are as they were.
        let data = drawn(&all(), pixel, None, Format::Png).data;
        let touched = data.iter().filter(|drawn| **drawn != pixel).count();
        assert!((500..15_000).contains(&touched), "{touched} of {}", data.len());
    }

    #[test]
    fn each_item_is_drawn_by_its_own_switch() {
        let black = Some([0.0; 3]);
        let clear = AnnotationsView::default();
        let items = [
            AnnotationsView { colour_bar: true, ..clear.clone() },
            AnnotationsView { axes: true, ..clear.clone() },
            AnnotationsView { time: true, ..clear.clone() },
            AnnotationsView { frame_number: true, ..clear.clone() },
            AnnotationsView { scale_bar: true, ..clear.clone() },
            AnnotationsView { title: "A".into(), ..clear.clone() },
            AnnotationsView { opacity_bar: true, ..clear.clone() },
        ];
        let lit = items.map(|look| {
            let pixels = drawn(&look, [0.0, 0.0, 0.0, 1.0], black, Format::Png);
            let lit: Vec<bool> = bytes(&pixels, black).iter().map(|byte| byte[0] > 128).collect();
            assert!(lit.iter().filter(|lit| **lit).count() > 10, "{look:?}");
            lit
        });
        for (a, b) in [(0, 1), (1, 4), (0, 5), (2, 5), (0, 4), (1, 6), (4, 6), (5, 6)] {
            let both = lit[a].iter().zip(&lit[b]).filter(|(a, b)| **a && **b).count();
            assert_eq!(both, 0, "items {a} and {b} lie over one another");
        }
    }

    #[test]
    fn letters_are_light_on_dark_and_dark_on_light_with_a_halo() {
        let extremes = |background: [f32; 3]| {
            let look = AnnotationsView { title: "MMM".into(), ..AnnotationsView::default() };
            let pixels = drawn(&look, [0.0; 4], Some(background), Format::Png);
            let bytes = bytes(&pixels, Some(background));
            assert!(bytes.iter().all(|byte| byte[3] == 255));
            [bytes.iter().map(|byte| byte[0]).min(), bytes.iter().map(|byte| byte[0]).max()]
        };
        let [darkest, lightest] = extremes([1.0; 3]);
        assert!(darkest < Some(60) && lightest == Some(255));
        let [darkest, lightest] = extremes([0.05; 3]);
        assert!(darkest < Some(40) && lightest > Some(200), "{darkest:?} {lightest:?}");
    }

    #[test]
    fn alpha_is_straight_in_png_and_premultiplied_in_exr() {
        let look = AnnotationsView { title: "MMM".into(), ..AnnotationsView::default() };
        let png = bytes(&drawn(&look, [0.0; 4], None, Format::Png), None);
        let full = png.iter().filter(|byte| byte[3] == 255).count();
        assert!(full > 10 && png.iter().any(|byte| byte[3] == 0), "{full}");
        assert!(png.iter().any(|byte| byte[3] > 20 && byte[3] < 200 && byte[0] < 60), "a soft dark halo");
        let exr = drawn(&look, [0.0; 4], None, Format::Exr);
        assert!(exr.data.iter().all(|[r, _, _, alpha]| r <= alpha && *alpha <= 1.0));
        // Over an opaque picture it stays opaque.
        let opaque = drawn(&look, [0.2, 0.2, 0.2, 1.0], None, Format::Exr);
        assert!(opaque.data.iter().all(|pixel| (pixel[3] - 1.0).abs() < 1e-6));
    }
}
