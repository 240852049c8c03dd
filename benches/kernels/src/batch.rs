//! What the kernels are given: the same points and boxes for all of them.

use iso_expr::engine::Boxes;

/// How many points or boxes one call is given: as many as the tracers do.
pub const COUNT: usize = 256;

/// Points spread evenly over a cube, and a small box around each.
pub struct Batch {
    points: [Vec<f64>; 3],
    lo: [Vec<f64>; 3],
    hi: [Vec<f64>; 3],
    forms: Vec<Vec<f64>>,
    direction: [Vec<f64>; 3],
}

impl Batch {
    /// [`COUNT`] points between −`radius` and `radius` along each axis, in boxes 1/64 as wide.
    ///
    /// The points are the sequence that adds 1/g, 1/g² and 1/g³ modulo 1, where g⁴ = g + 1
    /// (M. Roberts, 'The unreasonable effectiveness of quasirandom sequences', 2018).
    pub fn within(radius: f64) -> Self {
        const G: f64 = 1.2207440846057596;
        let points = [1, 2, 3].map(|axis| {
            let coordinate = |place| 2.0 * (0.5 + f64::from(place) * G.powi(-axis)).fract() - 1.0;
            (0..COUNT as u32).map(|place| radius * coordinate(place)).collect::<Vec<f64>>()
        });
        let moved =
            |by: f64| points.clone().map(|axis| axis.iter().map(|coordinate| coordinate + by).collect());
        let form = |axis: usize| {
            let part = |symbol: usize| vec![radius / if symbol == axis { 64.0 } else { 128.0 }; COUNT];
            [points[axis].clone(), part(0), part(1), part(2), vec![0.0; COUNT]]
        };
        let direction = [-0.5, -0.75, 0.375].map(|component| vec![component; COUNT]);
        let forms = (0..3).flat_map(form).chain(direction.clone()).collect();
        Self { direction, lo: moved(-radius / 64.0), hi: moved(radius / 64.0), forms, points }
    }

    /// The points.
    pub fn points(&self) -> [&[f64]; 3] {
        slices(&self.points)
    }

    /// The points, and a direction at each.
    pub fn points_and_directions(&self) -> [&[f64]; 6] {
        let ([x, y, z], [dx, dy, dz]) = (slices(&self.points), slices(&self.direction));
        [x, y, z, dx, dy, dz]
    }

    /// Affine forms of sets of points that lie askew around the points, part by part, and a direction.
    pub fn forms(&self) -> Vec<&[f64]> {
        self.forms.iter().map(Vec::as_slice).collect()
    }

    /// The boxes.
    pub fn boxes(&self) -> Boxes<'_> {
        Boxes { lo: slices(&self.lo), hi: slices(&self.hi) }
    }
}

fn slices([x, y, z]: &[Vec<f64>; 3]) -> [&[f64]; 3] {
    [x, y, z]
}
