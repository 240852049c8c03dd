//! About where the roots of many rays are, by a cubic through those of a few.

use pulp::Simd;

use crate::lanes::{Lanes, ROW, Row, parts};

/// Chebyshev's points of degree four, cos(3π/8) and cos(π/8): the roots of a polynomial that is small all over −1..1.
const NEAR: f64 = 0.382_683_432_365_089_8;
const FAR: f64 = 0.923_879_532_511_286_7;
const POINTS: [f64; 4] = [-FAR, -NEAR, NEAR, FAR];

/// Which products Tⱼ(u)·Tₖ(v) of Chebyshev's polynomials the cubic is a sum of, and those after them, by whose size its error is told.
const DEGREES: [[usize; 2]; 13] =
    [[0, 0], [1, 0], [0, 1], [2, 0], [1, 1], [0, 2], [3, 0], [2, 1], [1, 2], [0, 3], [3, 1], [2, 2], [1, 3]];

/// The factors of roots in the coefficients of these products: by discrete orthogonality (Mason and Handscomb, Chebyshev Polynomials, 2003,
/// section 4.6), means of the products with what stands at the points, twice for each degree that is not zero.
const FACTORS: [[Row; 2]; DEGREES.len()] = {
    let mut factors = [[[0.0; ROW]; 2]; DEGREES.len()];
    let mut term = 0;
    while term < DEGREES.len() {
        let [j, k] = DEGREES[term];
        let mut place = 0;
        while place < 2 * ROW {
            let (u, v) = (POINTS[place % 4], POINTS[place / 4]);
            factors[term][place / ROW][place % ROW] =
                norm(j) * norm(k) * chebyshev(j, u) * chebyshev(k, v) / 16.0;
            place += 1;
        }
        term += 1;
    }
    factors
};

const fn norm(degree: usize) -> f64 {
    if degree == 0 { 1.0 } else { 2.0 }
}

/// Chebyshev's polynomial of a degree up to three.
const fn chebyshev(degree: usize, x: f64) -> f64 {
    match degree {
        0 => 1.0,
        1 => x,
        2 => 2.0 * x * x - 1.0,
        _ => x * (4.0 * x * x - 3.0),
    }
}

/// A parallelogram of columns and rows of a tile, two sides of which are horizontal: u and v from −1 to 1 are in it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch {
    /// The column and the row in its middle.
    pub(super) middle: [f64; 2],
    /// How far its columns are from the middle of their row, and its rows from the middle, at most.
    pub(super) radii: [f64; 2],
    /// How many columns the middle moves from row to row.
    pub(super) shear: f64,
}

impl Patch {
    /// The columns and rows of the rays whose roots tell the others', which stand between those of the tile.
    pub(super) fn places(&self) -> [[Row; 2]; 2] {
        let at = |place: usize| {
            let (u, v) = (POINTS[place % 4], self.radii[1] * POINTS[place / 4]);
            [self.middle[0] + self.shear * v + self.radii[0] * u, self.middle[1] + v]
        };
        [0, ROW].map(|first| [0, 1].map(|axis| std::array::from_fn(|lane| at(first + lane)[axis])))
    }

    /// The cubic through the roots of these rays, as far as cubics go.
    #[inline(always)]
    pub(super) fn cubic<S: Simd>(&self, simd: S, roots: [&Row; 2]) -> Cubic {
        let coefficient = |[first, second]: &[Row; 2]| {
            let of = |row: &Row, part: usize| Lanes::of(simd, row, part);
            let product = |part| of(first, part) * of(roots[0], part) + of(second, part) * of(roots[1], part);
            (1..parts::<S>()).fold(product(0), |sum, part| sum + product(part)).sum()
        };
        let mut found = [0.0; DEGREES.len()];
        found.iter_mut().zip(&FACTORS).for_each(|(found, factors)| *found = coefficient(factors));
        let [one, u, v, uu, uv, vv, uuu, uuv, uvv, vvv, rest @ ..] = found;
        // T₄ is nothing at the points, but coefficients fall about evenly.
        let next = |second: f64, third: f64| third.abs().min(third * third / second.abs());
        let rest = rest.iter().map(|size| size.abs()).sum::<f64>() + next(uu, uuu) + next(vv, vvv);
        let terms = [
            one - uu - vv,
            u - 3.0 * uuu - uvv,
            v - 3.0 * vvv - uuv,
            2.0 * uu,
            uv,
            2.0 * vv,
            4.0 * uuu,
            2.0 * uuv,
            2.0 * uvv,
            4.0 * vvv,
        ];
        Cubic { patch: *self, terms, rest }
    }
}

/// About where the roots of the rays of a patch are: a cubic in u and v.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cubic {
    patch: Patch,
    /// The coefficients of 1, u, v, u², u·v, v², u³, u²·v, u·v² and v³.
    terms: [f64; 10],
    /// How far from there they are, about. No number, or infinite, where that is not known.
    pub(super) rest: f64,
}

impl Cubic {
    /// About where the roots of the rays in these columns and rows are.
    #[inline(always)]
    pub(super) fn at<S: Simd>(&self, [columns, rows]: [Lanes<S>; 2]) -> Lanes<S> {
        let all = |number| columns.all_be(number);
        let Patch { middle: [column, row], radii: [across, along], shear } = self.patch;
        let down = rows - all(row);
        let (u, v) =
            ((columns - all(column) - all(shear) * down) * all(1.0 / across), down * all(1.0 / along));
        let [one, by_u, by_v, uu, uv, vv, uuu, uuv, uvv, vvv] = self.terms.map(all);
        let of_v = by_v + v * (vv + v * vvv);
        let of_u = by_u + v * (uv + v * uvv) + u * (uu + v * uuv + u * uuu);
        one + v * of_v + u * of_u
    }
}

#[cfg(test)]
mod tests {
    use iso_expr::random::Random;
    use pulp::Scalar;

    use super::*;

    /// The cubic through what `roots` has at a patch's places.
    fn through(patch: &Patch, roots: impl Fn(f64, f64) -> f64) -> Cubic {
        let [first, second] = patch.places().map(|[columns, rows]| {
            let at: Row = std::array::from_fn(|lane| roots(columns[lane], rows[lane]));
            at
        });
        patch.cubic(Scalar::new(), [&first, &second])
    }

    fn at(cubic: &Cubic, column: f64, row: f64) -> f64 {
        // There is one lane.
        cubic.at([column, row].map(|number| Lanes::all(Scalar::new(), number))).sum()
    }

    fn patch(random: &mut Random) -> Patch {
        let mut between = |least, most| random.between(least, most);
        Patch {
            middle: [between(0.0, 60.0), between(0.0, 60.0)],
            radii: [between(1.0, 30.0), between(1.0, 30.0)],
            shear: between(-2.0, 2.0),
        }
    }

    #[test]
    fn cubics_are_found_as_they_are() {
        let mut random = Random::new(2);
        for _ in 0..200 {
            let patch = patch(&mut random);
            let factors = [(); 10].map(|()| random.between(-1.0, 1.0));
            let roots = |column: f64, row: f64| {
                let (a, b) = (0.02 * (column - 30.0), 0.02 * (row - 30.0));
                let powers = [1.0, a, b, a * a, a * b, b * b, a * a * a, a * a * b, a * b * b, b * b * b];
                factors.iter().zip(powers).map(|(factor, power)| factor * power).sum::<f64>()
            };
            let cubic = through(&patch, roots);
            for _ in 0..20 {
                let [u, v] = [(); 2].map(|()| random.between(-1.0, 1.0));
                let row = patch.middle[1] + patch.radii[1] * v;
                let column = patch.middle[0] + patch.radii[0] * u + patch.shear * (row - patch.middle[1]);
                let (found, expected) = (at(&cubic, column, row), roots(column, row));
                assert!((found - expected).abs() < 1e-12, "{found} for {expected}, {patch:?}");
            }
        }
    }

    /// On spheres, on one of whose sides rays nearly graze.
    #[test]
    fn the_rest_is_about_as_large_as_it_says() {
        let mut random = Random::new(3);
        let (mut most, mut least) = (0.0_f64, f64::INFINITY);
        for _ in 0..500 {
            let patch = Patch { radii: [8.0, 8.0], ..patch(&mut random) };
            let radius = random.between(100.0, 1000.0);
            let off = [(); 2].map(|()| random.between(-0.5, 0.5) * radius);
            let roots = |column: f64, row: f64| {
                let (a, b) = (column - patch.middle[0] - off[0], row - patch.middle[1] - off[1]);
                -(radius * radius - a * a - b * b).sqrt()
            };
            let cubic = through(&patch, roots);
            let mut error = 0.0_f64;
            for [u, v] in [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0], [0.0, 0.0], [1.0, 0.1]] {
                let row = patch.middle[1] + patch.radii[1] * v;
                let column = patch.middle[0] + patch.radii[0] * u + patch.shear * (row - patch.middle[1]);
                error = error.max((at(&cubic, column, row) - roots(column, row)).abs());
            }
            (most, least) = (most.max(error / cubic.rest), least.min(error / cubic.rest));
        }
        assert!(least > 0.2 && most < 5.0, "{least}..{most}");
    }

    #[test]
    fn nothing_is_known_where_a_root_is_no_number() {
        let patch = Patch { middle: [8.0; 2], radii: [8.0; 2], shear: 0.0 };
        assert!(
            through(&patch, |column, row| if column > 12.0 && row < 4.0 { f64::NAN } else { 1.0 })
                .rest
                .is_nan()
        );
        assert!(through(&patch, |_, _| 1.0).rest < 1e-15);
    }
}
