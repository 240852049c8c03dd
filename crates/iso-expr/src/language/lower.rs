//! From trees to programs.

use std::collections::HashMap;

use super::ast::{Ast, Definition, DefinitionId, Infix, Prefix, Term, TermId, Tree};
use super::builder::Builder;
use super::domain::Domain;
use super::error::{FormulaError, FormulaErrorKind};
use super::function::{Function, prelude};
use super::item::is_name;
use super::limits;
use super::scope::meaning_in_language;
use super::suggestion::nearest;
use crate::{NodeId, Operation, Program};

/// A formula ready for use: F as a program, and the parameters that it was made with.
#[derive(Clone, Debug)]
pub struct Formula {
    program: Program,
    value: Option<f64>,
    is_equation: bool,
    parameters: Vec<(String, f64)>,
    unused: Vec<String>,
}

impl Formula {
    /// F as it is, without parameters.
    pub(super) fn of_program(program: Program) -> Self {
        Self { program, value: None, is_equation: false, parameters: Vec::new(), unused: Vec::new() }
    }

    /// F, the program's one output. For an equation it is the left side less the right side.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// F in doubles, NaN where it is undefined; `None` for a formula that names a coordinate, and for models.
    pub fn value(&self) -> Option<f64> {
        self.value
    }

    /// Whether the formula is an equation, whose surface is where F = 0, or a bare expression, which has levels.
    pub fn is_equation(&self) -> bool {
        self.is_equation
    }

    /// The names and values of all parameters, in the order of their definitions.
    pub fn parameters(&self) -> &[(String, f64)] {
        &self.parameters
    }

    /// The names of definitions that the formula does without, in their order.
    pub fn unused(&self) -> &[String] {
        &self.unused
    }

    /// F − `level`, whose zeros are the surface; F itself for the level zero.
    pub fn minus_level(&self, level: f64) -> Program {
        let mut program = self.program.clone();
        if level != 0.0 {
            let level = program.literal(level);
            let difference = program.apply(Operation::Subtract, &[program.outputs()[0], level]);
            program.set_outputs(vec![difference]);
        }
        program
    }
}

impl Ast {
    /// The formula's program, with every definition put in, and with these values in place of its parameters'.
    /// Where a name is given several times, the last value counts.
    ///
    /// # Errors
    /// When a name is not a parameter of the formula or its value is not finite, and when the program exceeds
    /// [`limits`].
    pub fn lower(&self, parameters: &[(String, f64)]) -> Result<Formula, FormulaError> {
        let mut lowering =
            Lowering { ast: self, builder: Builder::default(), results: HashMap::new(), steps: 0 };
        for (name, value) in parameters {
            let id = self.parameter(name, *value)?;
            let value = lowering.builder.literal(*value);
            lowering.results.insert(Instance::of_value(id), value);
        }
        let parameters = lowering.parameters()?;
        let left = lowering.tree(&self.left)?;
        let mut output = match &self.right {
            Some(right) => {
                let right = lowering.tree(right)?;
                lowering.builder.apply(Operation::Subtract, &[left, right])?
            }
            None => left,
        };
        if let Some(Domain { margin, .. }) = &self.domain {
            output = lowering.cut(output, margin)?;
        }
        Ok(Formula {
            value: lowering.builder.value(output),
            program: lowering.builder.finish(output),
            is_equation: self.right.is_some(),
            parameters,
            unused: self.unused(),
        })
    }

    /// The parameter `name`, to which `value` may be given.
    fn parameter(&self, name: &str, value: f64) -> Result<DefinitionId, FormulaError> {
        let Some(place) = self.definitions.iter().position(|definition| definition.name == name) else {
            return Err(self.unknown_parameter(name));
        };
        let definition = &self.definitions[place];
        let name = name.to_owned();
        if !definition.is_parameter() {
            let meaning = if definition.parameters.is_empty() { "made of coordinates" } else { "a function" };
            let kind = FormulaErrorKind::NotAParameter { name, meaning };
            return Err(FormulaError::new(kind, definition.span.clone()));
        }
        if !value.is_finite() {
            return Err(FormulaError::new(
                FormulaErrorKind::InfiniteParameter { name },
                definition.span.clone(),
            ));
        }
        Ok(DefinitionId(place as u32))
    }

    fn unknown_parameter(&self, name: &str) -> FormulaError {
        let names = || self.definitions.iter().filter(|it| it.is_parameter()).map(|it| it.name.as_str());
        let meaning = meaning_in_language(name);
        let help = match nearest(name, names()) {
            Some(near) => format!("did you mean `{near}`?"),
            None if meaning.is_none() && !is_name(name) => {
                "a name is a letter, and letters, digits and `_` may follow".to_owned()
            }
            None if names().next().is_some() => {
                format!("its parameters are {}", names().take(20).collect::<Vec<_>>().join(", "))
            }
            None if meaning.is_some() => {
                "define one of another name before the formula, as in `a := 1`".to_owned()
            }
            None => format!("define one before the formula: `{name} := 1`"),
        };
        let name = name.to_owned();
        let kind = match meaning {
            Some(meaning) => FormulaErrorKind::NotAParameter { name, meaning },
            None => FormulaErrorKind::UnknownParameter { name },
        };
        FormulaError::new(kind, 0..0).with_help(help)
    }
}

/// A definition with the arguments that it is put in with; none for a value.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Instance {
    of_prelude: bool,
    id: DefinitionId,
    arguments: Vec<NodeId>,
}

impl Instance {
    fn of_value(id: DefinitionId) -> Self {
        Self { of_prelude: false, id, arguments: Vec::new() }
    }
}

/// A tree on the way to becoming nodes.
struct Frame<'a> {
    tree: &'a Tree,
    /// The nodes of the terms so far.
    nodes: Vec<NodeId>,
    /// What this frame makes; none for the formula itself.
    instance: Option<Instance>,
}

/// What a term needs before it is a node.
enum Step {
    Done(NodeId),
    Needs(Instance),
}

struct Lowering<'a> {
    ast: &'a Ast,
    builder: Builder,
    /// What each definition was lowered to, for each list of arguments.
    results: HashMap<Instance, NodeId>,
    steps: usize,
}

impl<'a> Lowering<'a> {
    /// The values of all parameters.
    fn parameters(&mut self) -> Result<Vec<(String, f64)>, FormulaError> {
        let mut parameters = Vec::new();
        for (place, definition) in self.ast.definitions.iter().enumerate() {
            if definition.is_parameter() {
                let instance = Instance::of_value(DefinitionId(place as u32));
                let node = match self.results.get(&instance) {
                    Some(node) => *node,
                    None => self.run(Frame {
                        tree: &definition.body,
                        nodes: Vec::new(),
                        instance: Some(instance),
                    })?,
                };
                let value = self.builder.value(node).expect("a parameter names no coordinate");
                parameters.push((definition.name.clone(), value));
            }
        }
        Ok(parameters)
    }

    /// Lowers a side of the formula.
    fn tree(&mut self, tree: &'a Tree) -> Result<NodeId, FormulaError> {
        self.run(Frame { tree, nodes: Vec::new(), instance: None })
    }

    /// F where `margin` is not negative, and nothing elsewhere: F + 0·√margin.
    fn cut(&mut self, value: NodeId, margin: &'a Tree) -> Result<NodeId, FormulaError> {
        let margin = self.tree(margin)?;
        let root = self.builder.apply(Operation::SquareRoot, &[margin])?;
        let zero = self.builder.literal(0.0);
        let nothing = self.builder.apply(Operation::Multiply, &[zero, root])?;
        self.builder.apply(Operation::Add, &[value, nothing])
    }

    /// Lowers one tree, and on the way each instance of a definition that it needs, once.
    fn run(&mut self, frame: Frame<'a>) -> Result<NodeId, FormulaError> {
        let mut frames = vec![frame];
        loop {
            let frame = frames.last_mut().expect("the first frame returns");
            if let Some(term) = frame.tree.terms().get(frame.nodes.len()) {
                match self.step(term, frame)? {
                    Step::Done(node) => frame.nodes.push(node),
                    Step::Needs(instance) => frames.push(self.frame(instance)),
                }
                continue;
            }
            let result = *frame.nodes.last().expect("a tree has a root");
            let frame = frames.pop().expect("it has just been looked at");
            if let Some(instance) = frame.instance {
                self.results.insert(instance, result);
            }
            if frames.is_empty() {
                return Ok(result);
            }
        }
    }

    fn frame(&self, instance: Instance) -> Frame<'a> {
        let definitions: &'a [Definition] =
            if instance.of_prelude { prelude() } else { &self.ast.definitions };
        Frame { tree: &definitions[instance.id.index()].body, nodes: Vec::new(), instance: Some(instance) }
    }

    fn step(&mut self, term: &Term, frame: &Frame<'_>) -> Result<Step, FormulaError> {
        self.steps += 1;
        if self.steps > limits::MOST_STEPS {
            let (given, allowed) = (self.steps, limits::MOST_STEPS);
            return Err(FormulaError::new(FormulaErrorKind::TooManySteps { given, allowed }, 0..0));
        }
        let node = |id: TermId| frame.nodes[id.index()];
        Ok(Step::Done(match term {
            Term::Number(value) => self.builder.literal(*value),
            Term::Variable(axis) => self.builder.variable(*axis),
            Term::Constant(constant) => self.builder.constant(constant.value()),
            Term::Parameter(place) => {
                let instance = frame.instance.as_ref().expect("parameters stand in definitions");
                instance.arguments[*place as usize]
            }
            Term::Prefix(prefix, operand) => self.prefix(*prefix, node(*operand))?,
            Term::Infix(infix, left, right) => self.infix(*infix, node(*left), node(*right))?,
            Term::Value(id) => return Ok(self.instance(Instance::of_value(*id))),
            Term::Call(function, arguments) => {
                let arguments: Vec<NodeId> = arguments.iter().map(|id| node(*id)).collect();
                return self.call(*function, arguments);
            }
        }))
    }

    fn call(&mut self, function: Function, arguments: Vec<NodeId>) -> Result<Step, FormulaError> {
        match function {
            Function::Operation(Operation::Select) => {
                let condition = self.builder.truth(arguments[0])?;
                let choice = [condition, arguments[1], arguments[2]];
                self.builder.apply(Operation::Select, &choice).map(Step::Done)
            }
            Function::Operation(operation) => self.builder.apply(operation, &arguments).map(Step::Done),
            Function::Fold(operation) => {
                let mut result = arguments[0];
                for argument in &arguments[1..] {
                    result = self.builder.apply(operation, &[result, *argument])?;
                }
                Ok(Step::Done(result))
            }
            Function::Prelude(id) => Ok(self.instance(Instance { of_prelude: true, id, arguments })),
            Function::Defined(id) => Ok(self.instance(Instance { of_prelude: false, id, arguments })),
        }
    }

    fn instance(&self, instance: Instance) -> Step {
        match self.results.get(&instance) {
            Some(node) => Step::Done(*node),
            None => Step::Needs(instance),
        }
    }

    fn prefix(&mut self, prefix: Prefix, operand: NodeId) -> Result<NodeId, FormulaError> {
        match prefix {
            Prefix::Negate => self.builder.apply(Operation::Negate, &[operand]),
            Prefix::Not => {
                let truth = self.builder.truth(operand)?;
                self.builder.not(truth)
            }
        }
    }

    fn infix(&mut self, infix: Infix, left: NodeId, right: NodeId) -> Result<NodeId, FormulaError> {
        let builder = &mut self.builder;
        match infix {
            Infix::Add => builder.apply(Operation::Add, &[left, right]),
            Infix::Subtract => builder.apply(Operation::Subtract, &[left, right]),
            Infix::Multiply => builder.apply(Operation::Multiply, &[left, right]),
            Infix::Divide => builder.apply(Operation::Divide, &[left, right]),
            Infix::Power => builder.power(left, right),
            Infix::Less => builder.apply(Operation::Less, &[left, right]),
            Infix::LessOrEqual => builder.apply(Operation::LessOrEqual, &[left, right]),
            Infix::Greater => builder.apply(Operation::Less, &[right, left]),
            Infix::GreaterOrEqual => builder.apply(Operation::LessOrEqual, &[right, left]),
            Infix::Equal => builder.apply(Operation::Equal, &[left, right]),
            Infix::NotEqual => {
                let equal = builder.apply(Operation::Equal, &[left, right])?;
                builder.not(equal)
            }
            Infix::And | Infix::Or => {
                let (left, right) = (builder.truth(left)?, builder.truth(right)?);
                if infix == Infix::And { builder.and(left, right) } else { builder.or(left, right) }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Axis, Node};

    fn lower(text: &str) -> Formula {
        Ast::parse(text).unwrap().lower(&[]).unwrap()
    }

    /// The operations of a program in their order.
    fn operations(program: &Program) -> Vec<Operation> {
        let operation = |node: &Node| match node {
            Node::Apply(operation, _) => Some(*operation),
            _ => None,
        };
        program.nodes().iter().filter_map(operation).collect()
    }

    #[test]
    fn an_integer_exponent_multiplies() {
        use Operation::*;
        assert_eq!(operations(lower("x^2").program()), [IntegerPower]);
        assert_eq!(operations(lower("n := 5 - 3; x^n").program()), [IntegerPower]);
        assert_eq!(operations(lower("x^-2").program()), [IntegerPower, Divide]);
        assert_eq!(operations(lower("x^1").program()), []);
        assert_eq!(operations(lower("x^0").program()), []);
        assert_eq!(operations(lower("x^1024").program()), [IntegerPower]);
        assert_eq!(operations(lower("x^1025").program()), [IntegerPower, Multiply]);
        assert_eq!(operations(lower("x^2.5").program()), [Power]);
        assert_eq!(operations(lower("e^x").program()), [Exp]);
        // Twenty tenths of a double are not the integer 2.
        assert_eq!(operations(lower("x^(20*0.1)").program()), [Multiply, Power]);
    }

    /// A number may be zero on a box and nothing else beside it, which a comparison tells.
    #[test]
    fn a_condition_is_a_truth() {
        use Operation::*;
        assert_eq!(operations(lower("if(x < 1, y, z)").program()), [Less, Select]);
        assert_eq!(operations(lower("if(max(x, 0), 5, y)").program()), [Maximum, Equal, Subtract, Select]);
    }

    #[test]
    fn what_is_equal_is_computed_once() {
        let formula = lower("f(u) := sin(u)^2; r := x + y; f(r) + f(x + y) + (x + y)");
        use Operation::*;
        assert_eq!(operations(formula.program()), [Add, Sin, IntegerPower, Add, Add]);
    }

    #[test]
    fn what_is_not_used_leaves_nothing() {
        let formula = lower("a := sqrt(2); b := exp(3); f(u) := ln(u); x");
        assert_eq!(formula.program().nodes(), [Node::Variable(Axis::X.into())]);
        let expected = [("a".to_owned(), std::f64::consts::SQRT_2), ("b".to_owned(), 20.085536923187668)];
        assert_eq!(formula.parameters(), expected);
    }

    #[test]
    fn a_formula_without_coordinates_has_a_value() {
        assert_eq!(lower("a := 2; sqrt(a) * pi").value(), Some(2f64.sqrt() * std::f64::consts::PI));
        assert_eq!(lower("3 = 1").value(), Some(2.0));
        assert!(lower("ln(-1)").value().unwrap().is_nan());
        assert_eq!(lower("x - x").value(), None);
    }

    /// Whoever does what the help says gets no other error.
    #[test]
    fn parameters_that_are_none_are_told_what_they_are() {
        let refused = |name: &str| {
            let error = Ast::parse("x = y").unwrap().lower(&[(name.to_owned(), 1.0)]).unwrap_err();
            (error.to_string(), error.help.unwrap())
        };
        for (name, meaning) in [
            ("x", "a coordinate"),
            ("pi", "a constant of the language"),
            ("π", "a constant of the language"),
            ("sin", "a function of the language"),
            ("clamp", "a function of the language"),
            ("where", "a word of the language"),
        ] {
            let (error, help) = refused(name);
            assert_eq!(error, format!("`{name}` is {meaning}, not a parameter"));
            assert!(help.contains("of another name"), "{name}: {help}");
        }
        for name in ["2", "2a", "a b", "a.b", "a := 1; b"] {
            let (error, help) = refused(name);
            assert_eq!(error, format!("the formula has no parameter `{name}`"));
            assert!(help.starts_with("a name is a letter"), "{name}: {help}");
        }
        for name in ["b", "r_2", "é"] {
            assert!(refused(name).1.ends_with(&format!("`{name} := 1`")));
            Ast::parse(&format!("{name} := 1; x = y")).unwrap();
        }
    }

    #[test]
    fn a_level_is_taken_from_an_expression() {
        let formula = lower("x^2");
        assert!(!formula.is_equation());
        assert_eq!(operations(&formula.minus_level(2.0)), [Operation::IntegerPower, Operation::Subtract]);
        assert_eq!(formula.minus_level(0.0).nodes(), formula.program().nodes());
        assert!(lower("x^2 = 2").is_equation());
    }
}
