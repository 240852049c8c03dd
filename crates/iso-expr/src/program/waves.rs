//! How many waves a program has on a box.

use super::{Node, Program};
use crate::{Interval, Operation};

impl Program {
    /// How far each sine and cosine gets on the box `domain`, in radians, as far as that is bounded: 2π is a wave.
    pub fn phases(&self, domain: [Interval; 3]) -> impl Iterator<Item = f64> {
        let enclosures = self.enclosures(domain);
        self.nodes.iter().filter_map(move |node| match node {
            Node::Apply(Operation::Sin | Operation::Cos, [angle, ..]) => {
                let Interval { lo, hi } = enclosures[angle.index()].interval;
                Some(hi - lo).filter(|phase| phase.is_finite())
            }
            _ => None,
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::{Ast, Interval};

    #[test]
    fn phases_are_those_of_what_waves() {
        for (text, expected) in [
            ("sin(x)cos(3y) + z", &[4.0, 12.0][..]),
            ("cos(x y) + tan(x) + x^2", &[8.0]),
            ("sin(1/x) + cos(2)", &[]),
            ("x + y", &[]),
        ] {
            let program = Ast::parse(text).unwrap().lower(&[]).unwrap().minus_level(0.0).simplified();
            let found: Vec<f64> = program.phases([Interval { lo: -2.0, hi: 2.0 }; 3]).collect();
            let is_near = |(found, expected): (&f64, &f64)| (found - expected).abs() < 1e-12;
            let are_near = found.len() == expected.len() && found.iter().zip(expected).all(is_near);
            assert!(are_near, "{text}: {found:?}");
        }
    }
}
