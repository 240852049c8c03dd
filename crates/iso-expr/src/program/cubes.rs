//! Sums of cubes, in place of which the sums of what is cubed have the same signs.
//!
//! A³ + B³·R, where R keeps its sign, is negative, zero or positive just where A + B·∛R is. Taubin's heart, (x² + 9/4·y² + z² − 1)³ −
//! x²z³ − 9/80·y²z³, is such a sum: all along its waist, where A and z are zero, its gradient vanishes, and near it F is not monotone along any ray.
//! A − z·∛(x² + 9/80·y²) has the same zeros, and a gradient at all of them but its tips.
//!
//! R is made of even powers, so that where it is zero it has no slope, if what is raised has one: a surface loses its gradient there either way, and
//! no gradient is lost by the root.

use super::{Node, NodeId, Program};
use crate::Operation;

/// Sums of more terms, and products of more factors, stay as they are.
const MOST_TERMS: usize = 16;

/// A product of powers and constants.
#[derive(Clone, Default)]
struct Product {
    is_negative: bool,
    /// What is multiplied by, or divided by.
    constants: Vec<(Operation, NodeId)>,
    /// What is multiplied, and how often.
    powers: Vec<(NodeId, u32)>,
}

impl Product {
    fn exponent(&self, base: NodeId) -> u32 {
        self.powers.iter().find(|(other, _)| *other == base).map_or(0, |(_, exponent)| *exponent)
    }

    fn multiply_by(&mut self, base: NodeId, exponent: u32) {
        match self.powers.iter_mut().find(|(other, _)| *other == base) {
            Some((_, sum)) => *sum += exponent,
            None => self.powers.push((base, exponent)),
        }
    }

    /// What of this product all others are multiples of the cube of.
    fn common_root(&self, others: &[Self]) -> Self {
        let common = |(base, exponent): &(NodeId, u32)| {
            let least = others.iter().map(|other| other.exponent(*base)).fold(*exponent, u32::min);
            (*base, least / 3)
        };
        let powers = self.powers.iter().map(common).filter(|(_, exponent)| *exponent > 0).collect();
        Self { powers, ..Self::default() }
    }

    /// This product over the cube of another one.
    fn over_cube_of(&self, root: &Self) -> Self {
        let rest = |(base, exponent): &(NodeId, u32)| (*base, exponent - 3 * root.exponent(*base));
        let powers = self.powers.iter().map(rest).filter(|(_, exponent)| *exponent > 0).collect();
        Self { powers, ..self.clone() }
    }
}

impl Program {
    /// A program with the same signs and roots in place of cubes, where F is a sum of such, or a minimum or maximum of sums.
    pub(super) fn without_cubes(&self) -> Self {
        let are_signs = self.asked_for_signs();
        // Nothing is built of the many programs that have none.
        let has_cubes = |((id, _), is_sign): ((NodeId, &Node), &bool)| *is_sign && self.cubes(id).is_some();
        if !self.iter().zip(&are_signs).any(has_cubes) {
            return self.clone();
        }
        let mut are_signs = are_signs.into_iter();
        let mut program = Self::new();
        program.outputs = program.import_with(self, |program, node| {
            let id = program.intern(node);
            let is_sign = are_signs.next().expect("there is one for each node");
            let cubes = is_sign.then(|| program.cubes(id)).flatten();
            cubes.map_or(id, |cubes| program.sum_of_roots(cubes))
        });
        program.simplified()
    }

    /// For each node whether nothing but its sign is asked for.
    fn asked_for_signs(&self) -> Vec<bool> {
        let (mut signs, mut values) = (vec![false; self.nodes.len()], vec![false; self.nodes.len()]);
        for output in &self.outputs {
            signs[output.index()] = true;
        }
        for (id, node) in self.iter().rev() {
            let keeps_signs =
                matches!(node, Node::Apply(Operation::Minimum | Operation::Maximum | Operation::Negate, _));
            let asked = if keeps_signs && !values[id.index()] { &mut signs } else { &mut values };
            for operand in node.operands() {
                asked[operand.index()] = true;
            }
        }
        signs.into_iter().zip(values).map(|(sign, value)| sign && !value).collect()
    }

    /// Two sums and cubes of products whose products a sum is the sum of: c and A, R and B where it is c·A³ + R·B³.
    fn cubes(&self, sum: NodeId) -> Option<[(Vec<Product>, Product); 2]> {
        let terms = self.terms(sum)?;
        (0..terms.len()).find_map(|place| {
            let mut others = terms.clone();
            let cube = others.remove(place);
            let root = cube.common_root(&[]);
            let has_root = !root.powers.is_empty() && cube.over_cube_of(&root).powers.is_empty();
            let common = others.first()?.common_root(&others);
            let rest: Vec<_> = others.iter().map(|other| other.over_cube_of(&common)).collect();
            if !has_root || common.powers.is_empty() || !self.keeps_its_sign(&rest) {
                return None;
            }
            let coefficient = Product { powers: Vec::new(), ..cube };
            Some([(vec![coefficient], root), (rest, common)])
        })
    }

    /// ∛c·A + ∛R·B
    fn sum_of_roots(&mut self, cubes: [(Vec<Product>, Product); 2]) -> NodeId {
        let roots = cubes.map(|(sum, root)| self.root_of_sum(&sum, &root));
        self.apply(Operation::Add, &roots)
    }

    /// The terms of a sum, if those are several and not too many.
    fn terms(&self, sum: NodeId) -> Option<Vec<Product>> {
        let mut terms = Vec::new();
        let mut ahead = vec![(sum, false)];
        while let Some((term, is_negative)) = ahead.pop() {
            match self.node(term) {
                Node::Apply(Operation::Add, [a, b, _]) => ahead.extend([(b, is_negative), (a, is_negative)]),
                Node::Apply(Operation::Subtract, [a, b, _]) => {
                    ahead.extend([(b, !is_negative), (a, is_negative)]);
                }
                Node::Apply(Operation::Negate, [a, ..]) => ahead.push((a, !is_negative)),
                _ => {
                    let product = self.factors(term)?;
                    terms.push(Product { is_negative: product.is_negative != is_negative, ..product });
                }
            }
            if terms.len() + ahead.len() > MOST_TERMS {
                return None;
            }
        }
        (terms.len() > 1).then_some(terms)
    }

    /// What a node is the product of, if that is not too much.
    fn factors(&self, node: NodeId) -> Option<Product> {
        let mut product = Product::default();
        let mut ahead = vec![node];
        while let Some(factor) = ahead.pop() {
            match self.node(factor) {
                Node::Constant(_) => product.constants.push((Operation::Multiply, factor)),
                Node::Apply(Operation::Negate, [a, ..]) => {
                    product.is_negative = !product.is_negative;
                    ahead.push(a);
                }
                Node::Apply(Operation::Multiply, [a, b, _]) => ahead.extend([b, a]),
                Node::Apply(Operation::Divide, [a, b, _]) if matches!(self.node(b), Node::Constant(_)) => {
                    product.constants.push((Operation::Divide, b));
                    ahead.push(a);
                }
                Node::Apply(Operation::IntegerPower, [base, exponent, _]) => {
                    product.multiply_by(base, self.exponent(exponent)?);
                }
                _ => product.multiply_by(factor, 1),
            }
            let is_too_high = |(_, exponent): &(NodeId, u32)| *exponent > Operation::LARGEST_POWER;
            let count = product.powers.len() + product.constants.len() + ahead.len();
            if count > MOST_TERMS || product.powers.iter().any(is_too_high) {
                return None;
            }
        }
        Some(product)
    }

    /// Whether a sum of even powers, of sums of such, and of constants is nowhere negative, or nowhere positive.
    fn keeps_its_sign(&self, terms: &[Product]) -> bool {
        let of_sum = |base| self.common_sign(&self.terms(base)?, |_| None);
        self.common_sign(terms, of_sum).is_some()
    }

    /// Whether all terms are negative, or none is, where they are not zero. Of what has an odd power `is_negative` tells the sign.
    fn common_sign(&self, terms: &[Product], is_negative: impl Fn(NodeId) -> Option<bool>) -> Option<bool> {
        let sign = |term: &Product| {
            let mut sign = term.is_negative;
            for (_, constant) in &term.constants {
                let Node::Constant(constant) = self.node(*constant) else { return None };
                let enclosure = constant.enclosure();
                if enclosure.contains_zero() {
                    return None;
                }
                sign ^= enclosure.hi < 0.0;
            }
            for (base, _) in term.powers.iter().filter(|(_, exponent)| !exponent.is_multiple_of(2)) {
                sign ^= is_negative(*base)?;
            }
            Some(sign)
        };
        let first = sign(terms.first()?)?;
        terms.iter().all(|term| sign(term) == Some(first)).then_some(first)
    }

    /// `root` times the cube root of a sum.
    fn root_of_sum(&mut self, terms: &[Product], root: &Product) -> NodeId {
        let terms: Vec<_> = terms.iter().map(|term| self.product_of(term)).collect();
        let sum = terms.into_iter().reduce(|sum, term| self.apply(Operation::Add, &[sum, term]));
        let root_of_sum = self.apply(Operation::CubeRoot, &[sum.expect("a sum has terms")]);
        let root = self.product_of(root);
        self.apply(Operation::Multiply, &[root_of_sum, root])
    }

    fn product_of(&mut self, product: &Product) -> NodeId {
        let mut value = self.literal(if product.is_negative { -1.0 } else { 1.0 });
        for (operation, constant) in &product.constants {
            value = self.apply(*operation, &[value, *constant]);
        }
        for (base, exponent) in &product.powers {
            let power = if *exponent == 1 { *base } else { self.integer_power(*base, *exponent) };
            value = self.apply(Operation::Multiply, &[value, power]);
        }
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::{Ast, Interval};

    const HEART: &str = "(x^2 + 9/4 y^2 + z^2 - 1)^3 - x^2 z^3 - 9/80 y^2 z^3";

    fn read(text: &str) -> Program {
        Ast::parse(text).unwrap().lower(&[]).unwrap().minus_level(0.0).simplified()
    }

    fn count(program: &Program, wanted: Operation) -> usize {
        let is_wanted = |node: &&Node| matches!(node, Node::Apply(operation, _) if *operation == wanted);
        program.nodes().iter().filter(is_wanted).count()
    }

    fn enclosed_at(program: &Program, point: [f64; 3]) -> Interval {
        program.enclosures(point.map(Interval::point))[program.outputs()[0].index()].interval
    }

    #[test]
    fn signs_stay_the_same() {
        let formulas = [
            HEART,
            "(x^2 + 9 y^2 / 4 + z^2 - 1)^3 - (x^2 + 0.1125 y^2) z^2 z",
            "x^2 z^3 - (x^2 + 2 y^2 + z^2 - 1)^3 / 5",
            "-2(x + y)^3 - 3 (y - 1)^5 z^4 x^3 y",
            "8 x^3 - 27 y^3",
            "min(z - 0.5, -(max(x^3 - y^3 z^2, (x y)^3 + 3 z^6)))",
        ];
        let mut random = Random::new(1);
        for formula in formulas {
            let (whole, rooted) = (read(formula), read(formula).without_cubes());
            let mut decided = 0;
            for _ in 0..2000 {
                let point = [0; 3].map(|_| random.below(4001) as f64 / 1000.0 - 2.0);
                let [whole, rooted] = [&whole, &rooted].map(|program| enclosed_at(program, point));
                assert!(whole.lo <= 0.0 || rooted.hi >= 0.0, "{formula} at {point:?}: {whole} and {rooted}");
                assert!(whole.hi >= 0.0 || rooted.lo <= 0.0, "{formula} at {point:?}: {whole} and {rooted}");
                decided += i32::from(!whole.contains_zero() && !rooted.contains_zero());
            }
            assert!(decided > 1900, "{formula}: {decided} signs");
        }
    }

    #[test]
    fn cubes_are_rooted_by_roots() {
        for formula in [HEART, "(x^2 + 2 y^2 + z^2 - 1)^3 = (x^2 + y^2/9) z^3", "z^6 x^2 / 3 - (x - y)^3"] {
            let rooted = read(formula).without_cubes();
            assert_eq!(count(&rooted, Operation::CubeRoot), 1, "{formula} became\n{rooted}");
            assert!(rooted.operations() <= read(formula).operations(), "{formula} became\n{rooted}");
        }
        assert_eq!(read("8 x^3 - 27 y^3").without_cubes().operations(), read("2 x - 3 y").operations());
    }

    #[test]
    fn others_stay_as_they_are() {
        let formulas = [
            // R changes its sign, or may be zero everywhere.
            "(x^2 + y^2 + z^2 - 1)^3 - x z^3",
            "(x^2 + y^2 - 1)^3 - (x^2 - y^2) z^3",
            // There is no common cube, or something is no cube.
            "x^3 + y^3 + z^3",
            "x^3 - y^2 z^2",
            "x^2 - y^3 z^2",
            "(x^2 + y^2 + z^2 - 1)^3 - x^2 z^3 - 0.1",
            // A power is too high.
            "x^1500 z^3 + y^2 z^3 - x^3",
            // Its value is asked for.
            "sqrt(x^3 - y^3 z^2) - 1",
            "max(x^3 - y^3 z^2, z) - 1",
            "min(x^3 - y^3 z^2, sin(x^3 - y^3 z^2))",
        ];
        for formula in formulas {
            assert_eq!(read(formula).without_cubes(), read(formula), "{formula}");
        }
    }

    #[test]
    fn each_of_several_is_rooted_by_itself() {
        let rooted = read(&format!("max(y, -min(z, {HEART}, x^3 - 2 y^3))")).without_cubes();
        assert_eq!(count(&rooted, Operation::CubeRoot), 1, "{rooted}");
        assert_eq!(rooted.without_cubes(), rooted);
    }
}
