//! Transfer function (contract, section 1): colour and opacity of a normalised value.

use renderer::ControlPoint;

/// Control points in ascending order of u.
#[derive(Clone, Debug)]
pub struct Transfer {
    /// u of each point, with colour (linear light) and opacity of one reference length.
    points: Vec<(f64, [f64; 4])>,
}

impl Transfer {
    /// Takes the points of a view, which must ascend in u.
    pub fn new(points: &[ControlPoint]) -> Transfer {
        assert!(points.is_sorted_by_key(|point| point.u), "points ascend in u");
        let point = |p: &ControlPoint| {
            let value = [p.rgb[0], p.rgb[1], p.rgb[2], p.opacity].map(f64::from);
            (f64::from(p.u), value)
        };
        Transfer { points: points.iter().map(point).collect() }
    }

    /// Distance from `u` to the nearest step; infinite without one.
    pub fn distance_to_step(&self, u: f64) -> f64 {
        let steps = self.points.windows(2).filter(|pair| pair[0].0 == pair[1].0);
        steps.map(|pair| (u - pair[0].0).abs()).fold(f64::INFINITY, f64::min)
    }

    /// Colour and opacity at `u`: linear between two points, constant outside; where points share
    /// their u, the last of them holds.
    pub fn at(&self, u: f64) -> [f64; 4] {
        let Some(below) = self.points.iter().rposition(|(at, _)| *at <= u) else {
            return self.points[0].1;
        };
        let (low, a) = self.points[below];
        let Some(&(high, b)) = self.points.get(below + 1) else {
            return a;
        };
        let share = (u - low) / (high - low);
        std::array::from_fn(|channel| (1.0 - share) * a[channel] + share * b[channel])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn transfer(points: &[(f32, f32)]) -> Transfer {
        let point = |&(u, value): &(f32, f32)| ControlPoint { u, rgb: [value; 3], opacity: value };
        Transfer::new(&points.iter().map(point).collect::<Vec<_>>())
    }

    #[test]
    fn linear_between_points_and_constant_outside() {
        let transfer = transfer(&[(0.25, 0.0), (0.5, 1.0), (0.75, 0.5)]);
        for (u, value) in
            [(0.0, 0.0), (0.25, 0.0), (0.3125, 0.25), (0.5, 1.0), (0.625, 0.75), (0.75, 0.5), (1.0, 0.5)]
        {
            assert_eq!(transfer.at(u), [value; 4], "at {u}");
        }
    }

    #[test]
    fn the_later_point_of_a_step_holds() {
        let transfer = transfer(&[(0.0, 0.25), (0.5, 0.25), (0.5, 0.75), (1.0, 0.75)]);
        assert_eq!(transfer.at(0.5_f64.next_down()), [0.25; 4]);
        assert_eq!(transfer.at(0.5), [0.75; 4]);
    }

    #[test]
    fn steps_at_both_ends_and_of_three_points() {
        let transfer =
            transfer(&[(0.0, 1.0), (0.0, 0.0), (0.5, 0.0), (0.5, 1.0), (0.5, 0.5), (1.0, 0.5), (1.0, 1.0)]);
        assert_eq!(transfer.at(0.0), [0.0; 4]);
        assert_eq!(transfer.at(0.5), [0.5; 4]);
        assert_eq!(transfer.at(1.0), [1.0; 4]);
    }

    #[test]
    fn steps_are_found() {
        let transfer = transfer(&[(0.25, 0.0), (0.5, 0.0), (0.5, 1.0), (1.0, 1.0), (1.0, 0.0)]);
        assert_eq!([0.25, 0.5, 1.0].map(|u| transfer.distance_to_step(u)), [0.25, 0.0, 0.0]);
        assert_eq!(Transfer { points: vec![(0.5, [0.0; 4])] }.distance_to_step(0.5), f64::INFINITY);
    }

    #[test]
    fn one_point_is_a_constant() {
        let transfer = transfer(&[(0.5, 0.25)]);
        assert_eq!([0.0, 0.5, 1.0].map(|u| transfer.at(u)), [[0.25; 4]; 3]);
    }

    #[test]
    fn channels_keep_their_places() {
        let point = ControlPoint { u: 0.0, rgb: [0.125, 0.25, 0.5], opacity: 0.75 };
        assert_eq!(Transfer::new(&[point]).at(0.3), [0.125, 0.25, 0.5, 0.75]);
    }
}
