//! The syntax tree: what the text says, nothing resolved.
//!
//! Names are strings with places, numbers are as written, families and sugar are still there.

#![allow(missing_docs, reason = "the fields of each variant are what its syntax shows")]

use crate::exact::Rational;
use crate::source::Span;

/// A name with its place.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Name {
    /// The identifier.
    pub text: String,
    /// Where it stands.
    pub span: Span,
}

/// A documentation comment (`///` lines joined by newlines, without the slashes).
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Doc {
    /// The text.
    pub text: String,
    /// Where it stands.
    pub span: Span,
}

/// A whole mission file.
#[derive(Clone, PartialEq, Debug)]
pub struct File {
    /// The `//!` lines at the top, joined by newlines.
    pub doc: Option<Doc>,
    /// All declarations that could be read, in order.
    pub items: Vec<Item>,
    /// `///` comments that document nothing (a warning each).
    pub stray_docs: Vec<Span>,
    /// The declarations that could not be read; an error was reported for each.
    pub broken: Vec<Broken>,
    /// The whole text.
    pub span: Span,
}

impl File {
    /// Whether a declaration of this name could not be read, so that its absence is no news.
    pub fn has_broken(&self, name: &str) -> bool {
        self.broken.iter().any(|b| b.name.as_ref().is_some_and(|n| n.text == name))
    }

    /// Whether a declaration that begins with this word could not be read.
    pub fn has_broken_keyword(&self, keyword: &str) -> bool {
        self.broken.iter().any(|b| b.keyword == keyword)
    }
}

/// A declaration that could not be read.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Broken {
    /// The word that it begins with (`opaque obstacle` begins with `obstacle`): the keyword that is
    /// spelt nearly so, else whatever stands there.
    pub keyword: String,
    /// The name that it was to declare, where one can be seen.
    pub name: Option<Name>,
    /// The place of all of it.
    pub span: Span,
}

/// A declaration.
#[derive(Clone, PartialEq, Debug)]
pub struct Item {
    /// Its `///` comment.
    pub doc: Option<Doc>,
    /// The whole declaration, without its comment.
    pub span: Span,
    /// What it declares.
    pub kind: ItemKind,
}

/// The kinds of declaration.
#[derive(Clone, PartialEq, Debug)]
pub enum ItemKind {
    /// `dosm 1`
    Edition(Number),
    /// `mission NAME`
    Mission(Name),
    /// `param NAME = EXPR`
    Param { name: Name, value: Expr },
    /// `let NAME = EXPR`, tables included
    Let { name: Name, value: Expr },
    /// `workspace SHAPE`
    Workspace(Shape),
    /// `region NAME = SHAPE`
    Region { name: FamilyName, shape: Shape },
    /// `obstacle NAME = SHAPE`, `opaque obstacle …`
    Obstacle { opaque: bool, name: FamilyName, shape: Shape },
    /// `jammer NAME = SHAPE`
    Jammer { name: FamilyName, shape: Shape },
    /// `base NAME at POINT`
    Base { name: FamilyName, at: Point },
    /// `dynamics NAME { … }`
    Dynamics { name: Name, items: Vec<DynamicsItem> },
    /// `robot NAME: DYNAMICS at STATE`
    Robot { name: FamilyName, dynamics: Name, at: State },
    /// `team NAME = ROBOT, …`
    Team { name: Name, members: Vec<Reference> },
    /// `separation LENGTH`
    Separation(Expr),
    /// `connectivity { … }`, `connectivity none`
    Connectivity(Connectivity),
    /// `horizon A..B`
    Horizon { from: Expr, to: Expr },
    /// `minimize effort`, `minimize length`: the word as written
    Minimize(Name),
    /// `goal NAME: FORMULA`
    Goal { name: Name, formula: Formula },
    /// `define NAME = FORMULA`
    Define { name: Name, formula: Formula },
}

/// A declared name, with indices when it declares a family: `fleet[i in 1..n, j in 1..2]`.
#[derive(Clone, PartialEq, Debug)]
pub struct FamilyName {
    /// The family's or the single member's name.
    pub name: Name,
    /// Empty for a single member.
    pub indices: Vec<IndexRange>,
}

/// `i in A..B`
#[derive(Clone, PartialEq, Debug)]
pub struct IndexRange {
    /// The index variable.
    pub variable: Name,
    /// The first value.
    pub from: Expr,
    /// The last value.
    pub to: Expr,
}

/// A use of a name, with indices when it names a member: `fleet[1]`, `J[i, 2]`.
#[derive(Clone, PartialEq, Debug)]
pub struct Reference {
    /// The name.
    pub name: Name,
    /// Empty when the name stands alone.
    pub indices: Vec<Expr>,
    /// Name and indices.
    pub span: Span,
}

/// A number as written.
#[derive(Clone, PartialEq, Debug)]
pub struct Number {
    /// Its exact value.
    pub value: Rational,
    /// Where it stands.
    pub span: Span,
}

/// A unit as written, without blanks: `m/s^2`.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Unit {
    /// The factors in order: unit symbol (`m`, `cm`, …, or `1`) and signed exponent (`/` negates it).
    pub factors: Vec<(String, i32)>,
    /// Where it stands.
    pub span: Span,
}

/// An expression over constants; in `where` also over coordinates and states.
#[derive(Clone, PartialEq, Debug)]
pub struct Expr {
    /// The whole expression.
    pub span: Span,
    /// What it is.
    pub kind: ExprKind,
}

/// The kinds of expression.
#[derive(Clone, PartialEq, Debug)]
pub enum ExprKind {
    /// `0.5`
    Number(Rational),
    /// `0.5 s`, `(a + b) m`: the inside with a unit behind it
    WithUnit(Box<Expr>, Unit),
    /// A name or an entry of a table: `radius`, `P[i, 1]`
    Name(Reference),
    /// `sqrt(2)`, `max(a, b)`
    Call { function: Name, arguments: Vec<Expr> },
    /// `-a`
    Negate(Box<Expr>),
    /// `a + b` and the like
    Binary { op: BinaryOp, left: Box<Expr>, right: Box<Expr> },
    /// `(a)`
    Parenthesised(Box<Expr>),
    /// `[1, 2; 3, 4]`: only as the value of a `let` or a matrix
    Table(Vec<Vec<Expr>>),
}

/// The arithmetic operators.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum BinaryOp {
    /// `+`
    Add,
    /// `-`
    Subtract,
    /// `*`
    Multiply,
    /// `/`
    Divide,
    /// `^`
    Power,
}

/// `(4, 7)`, `(4, 7) m`
#[derive(Clone, PartialEq, Debug)]
pub struct Point {
    /// The coordinates.
    pub coordinates: Vec<Coordinate>,
    /// A unit behind the bracket.
    pub unit: Option<Unit>,
    /// The whole point.
    pub span: Span,
}

/// A number that may be uncertain: `4`, `4 +/- 0.3`.
#[derive(Clone, PartialEq, Debug)]
pub struct Coordinate {
    /// The middle.
    pub value: Expr,
    /// What follows `+/-`.
    pub uncertainty: Option<Expr>,
}

/// A shape: the union of at least one piece.
#[derive(Clone, PartialEq, Debug)]
pub struct Shape {
    /// The operands of `or`.
    pub pieces: Vec<Piece>,
    /// The whole shape.
    pub span: Span,
}

/// One convex shape.
#[derive(Clone, PartialEq, Debug)]
pub struct Piece {
    /// The whole piece.
    pub span: Span,
    /// What it is.
    pub kind: PieceKind,
}

/// The kinds of convex shape.
#[derive(Clone, PartialEq, Debug)]
pub enum PieceKind {
    /// `box P .. Q`
    Box(Point, Point),
    /// `ball C radius r norm 1`; `disc` sets `disc`
    Ball { center: Point, radius: Coordinate, norm: Option<Norm>, disc: bool },
    /// `polygon P1, P2, …`
    Polygon(Vec<Point>),
    /// `hull P1, P2, …`
    Hull(Vec<Point>),
    /// `where { x + y <= 2; … }`
    Where(Vec<Inequality>),
}

/// The norm of a ball or a range, with its place.
#[derive(Clone, PartialEq, Debug)]
pub struct Norm {
    /// 1 or 2, or whatever was written.
    pub value: Number,
}

/// `x + y <= 2`
#[derive(Clone, PartialEq, Debug)]
pub struct Inequality {
    /// The left-hand side.
    pub left: Expr,
    /// `<=`, `>=`, `<`, `>`, `=` or `!=`
    pub op: Comparison,
    /// Where the operator stands.
    pub op_span: Span,
    /// The right-hand side.
    pub right: Expr,
    /// The whole inequality.
    pub span: Span,
}

/// The comparison operators.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Comparison {
    /// `=`
    Equal,
    /// `!=`
    NotEqual,
    /// `<`
    Less,
    /// `<=`
    LessEqual,
    /// `>`
    Greater,
    /// `>=`
    GreaterEqual,
}

/// An item of a `dynamics` block.
#[derive(Clone, PartialEq, Debug)]
pub struct DynamicsItem {
    /// Its `///` comment.
    pub doc: Option<Doc>,
    /// The whole item.
    pub span: Span,
    /// What it says.
    pub kind: DynamicsKind,
}

/// The kinds of item in a `dynamics` block.
#[derive(Clone, PartialEq, Debug)]
pub enum DynamicsKind {
    /// `step 0.5 s`
    Step(Expr),
    /// `state px: m, vx: m/s`
    State(Vec<Signal>),
    /// `input ax: m/s^2`
    Input(Vec<Signal>),
    /// `position px, py`
    Position(Vec<Name>),
    /// `A = [ … ]`, `B = [ … ]`, `c = [ … ]`: the letter and the table
    Matrix { letter: Name, value: Expr },
    /// `continuous`
    Continuous,
    /// `integrator 2`
    Integrator(Expr),
    /// `bound vx, vy in [-4, 4] m/s`
    Bound { names: Vec<Name>, interval: Interval },
    /// `bound where { vx + vy <= 5 }`
    BoundWhere(Vec<Inequality>),
    /// `disturbance px, py in [-0.2, 0.2] m`
    Disturbance { names: Vec<Name>, interval: Interval },
    /// `rejection 0.5`
    Rejection(Expr),
    /// `mode NAME when { … } { A = … }`
    Mode { name: Name, when: Vec<Inequality>, items: Vec<DynamicsItem> },
}

/// A state or an input with its unit.
#[derive(Clone, PartialEq, Debug)]
pub struct Signal {
    /// Its `///` comment.
    pub doc: Option<Doc>,
    /// Its name.
    pub name: Name,
    /// Its unit.
    pub unit: Unit,
}

/// `[-4, 4] m/s`
#[derive(Clone, PartialEq, Debug)]
pub struct Interval {
    /// The lower end.
    pub from: Expr,
    /// The upper end.
    pub to: Expr,
    /// A unit behind the bracket.
    pub unit: Option<Unit>,
    /// The whole interval.
    pub span: Span,
}

/// What follows a robot's `at`.
#[derive(Clone, PartialEq, Debug)]
pub enum State {
    /// A position; the other states are 0.
    Position(Point),
    /// `{ px = 4.5, vx = 0.2 }`
    Full { entries: Vec<(Name, Expr)>, span: Span },
}

/// What follows `connectivity`.
#[derive(Clone, PartialEq, Debug)]
pub enum Connectivity {
    /// `none`
    None,
    /// `{ … }`
    Items(Vec<ConnectivityItem>),
}

/// An item of a `connectivity` block.
#[derive(Clone, PartialEq, Debug)]
pub struct ConnectivityItem {
    /// The whole item.
    pub span: Span,
    /// What it says.
    pub kind: ConnectivityKind,
}

/// The kinds of item in a `connectivity` block.
#[derive(Clone, PartialEq, Debug)]
pub enum ConnectivityKind {
    /// `hops <= 3`
    Hops(Expr),
    /// `range 6 m`, `range 6 m norm 2`
    Range { length: Expr, norm: Option<Norm> },
    /// `redundancy 1`
    Redundancy(Expr),
    /// `every 2 s`, `every 4`
    Every(Expr),
}

/// A formula.
#[derive(Clone, PartialEq, Debug)]
pub struct Formula {
    /// The whole formula.
    pub span: Span,
    /// What it is.
    pub kind: FormulaKind,
}

/// The kinds of formula.
#[derive(Clone, PartialEq, Debug)]
pub enum FormulaKind {
    /// `true`, `false`
    Constant(bool),
    /// `ROBOT in REGION`
    In { robot: Reference, region: Reference },
    /// A defined name.
    Name(Name),
    /// A comparison of sums.
    Compare { left: Sum, op: Comparison, right: Sum },
    /// `not`, `always` and the like, with a window where one is written
    Unary { op: UnaryOp, window: Option<Window>, operand: Box<Formula> },
    /// `and`, `until` and the like, with a window where one is written
    Binary { op: BinaryConnective, window: Option<Window>, left: Box<Formula>, right: Box<Formula> },
    /// `forall r in SET: …`, `exists r in SET: …`
    QuantifiedRobot { universal: bool, variable: Name, set: Vec<Reference>, body: Box<Formula> },
    /// `forall i in A..B: …`, `exists i in A..B: …`
    QuantifiedIndex { universal: bool, range: IndexRange, body: Box<Formula> },
    /// `(FORMULA)`
    Parenthesised(Box<Formula>),
}

/// The prefix operators.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum UnaryOp {
    /// `not`, `!`
    Not,
    /// `next`, `X`
    Next,
    /// `always`, `G`, `[]`
    Always,
    /// `eventually`, `F`, `<>`
    Eventually,
}

/// The infix operators.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum BinaryConnective {
    /// `<->`
    Iff,
    /// `->`
    Implies,
    /// `or`, `||`
    Or,
    /// `and`, `&&`
    And,
    /// `until`, `U`
    Until,
    /// `release`, `R`
    Release,
    /// `weak until`, `W`
    WeakUntil,
    /// `strong release`, `M`
    StrongRelease,
}

/// `[5, 9]`, `[0 s, 10 s]`
#[derive(Clone, PartialEq, Debug)]
pub struct Window {
    /// The first step or time.
    pub from: Expr,
    /// The last step or time.
    pub to: Expr,
    /// The whole window.
    pub span: Span,
}

/// Terms joined by `+` and `-`.
#[derive(Clone, PartialEq, Debug)]
pub struct Sum {
    /// The terms with their signs.
    pub terms: Vec<Term>,
    /// The whole sum.
    pub span: Span,
}

/// A term of a sum.
#[derive(Clone, PartialEq, Debug)]
pub struct Term {
    /// Whether it is subtracted.
    pub negative: bool,
    /// The factor before `*`.
    pub factor: Option<Expr>,
    /// What is counted.
    pub kind: TermKind,
    /// The term without its sign.
    pub span: Span,
}

/// The kinds of term.
#[derive(Clone, PartialEq, Debug)]
pub enum TermKind {
    /// `count(r in SET: r in REGION)`; `all` is a reference named `all`
    Count { variable: Name, set: Vec<Reference>, member: Reference, region: Reference },
    /// `(ROBOT in REGION)`
    In { robot: Reference, region: Reference },
    /// An integer constant.
    Constant(Expr),
}
