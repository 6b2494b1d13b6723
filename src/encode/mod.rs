//! Step 2: the Boolean part, which grows with the length and on demand.
//!
//! The encoder writes clauses and never sees a solver. It starts from little (the goals, the lasso
//! and who may talk to whom) and gets the rest as *demands*: keep this robot clear of that solid,
//! clear this link, keep these two apart. A refutation of what is there refutes the whole.

mod circuit;
mod compare;
mod connectivity;
mod convex;
mod justify;
mod leaf;
mod links;
mod paper;
mod paper_links;
mod range;
mod temporal;
mod whole;

pub use circuit::Bit;
pub use connectivity::{is_asked, losses};
pub use convex::{Block, Cone, Convex, Relation, Row, Variable};
pub use leaf::{Anywhere, Face, Leaf, Near, Reach};
pub use links::Link;
pub use range::link_models;
pub use whole::{Instance, Meaning, TooLarge, number};

use std::collections::{HashMap, HashSet};

use rustsat::OutOfMemory;
use rustsat::encodings::CollectClauses;
use rustsat::types::Lit;

use crate::abstraction::{Abstraction, HalfSpace, Owner, Passage, SolidId, Stage};
use crate::ir::{BaseId, Comparison, ModelId, Problem, RegionId, RobotId};

use circuit::{Circuit, Gate};
use leaf::HalfSpaces;
use links::StepLinks;
use paper::CellVariables;
use temporal::{Ask, Temporal};

/// One end of what must be clear of a solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum End {
    /// A robot's tube at a step.
    Robot(RobotId, usize),
    /// A base.
    Base(BaseId),
}

/// What a search may switch on when the rest is refuted, each under an assumption of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Switch {
    /// Separation by constraints on two robots at once.
    Coupled,
    /// Tangents from bases.
    Tangents,
    /// Oblique directions.
    Oblique,
}

impl Switch {
    /// All switches.
    pub const ALL: [Switch; 3] = [Switch::Coupled, Switch::Tangents, Switch::Oblique];
}

/// How many times the space between two robots is cut before they are held apart by constraints on
/// both at once: programs of one robot are small, those of all robots that come close are not.
const CUTS: usize = 4;

/// A disjunct behind a switch, which gets its meaning when some candidate turns on it.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
enum Deferred {
    Clear(Stage, SolidId, Vec<End>),
    /// The separation of two robots during a step, and how many times it was cut.
    Apart(RobotId, RobotId, usize, usize),
}

/// Counts for reports.
#[derive(Clone, Copy, Debug, Default)]
pub struct Counts {
    /// Half-space literals.
    pub half_spaces: usize,
    /// All variables.
    pub variables: usize,
    /// The variables that communication took.
    pub connectivity: usize,
    /// Clauses written.
    pub clauses: usize,
}

/// The Boolean part of a problem.
pub struct Encoder<'a> {
    problem: &'a Problem,
    abstraction: &'a Abstraction,
    reach: Box<dyn Reach + 'a>,
    /// Whether everything gets its whole meaning at once.
    eager: bool,
    circuit: Circuit,
    half_spaces: HalfSpaces,
    temporal: Temporal,
    links: Vec<StepLinks>,
    /// By step: 'every robot reaches a base', where that is asked of some loops only.
    connected: Vec<Option<Lit>>,
    /// With the paper's encoding: the cells.
    cells: Option<CellVariables<'a>>,
    /// By position: it is the last one.
    lasts: Vec<Lit>,
    /// By length: the loop goes back to position k.
    loops: Vec<Vec<Lit>>,
    switches: [Lit; 3],
    /// What has no meaning yet.
    deferred: HashMap<Deferred, Lit>,
    atoms: HashMap<(RobotId, RegionId, usize), (Bit, Bit)>,
    clears: HashMap<(SolidId, Vec<End>), Bit>,
    passages: HashMap<ModelId, Option<Passage>>,
    access: HashMap<(RobotId, RegionId, usize), bool>,
    apart: HashSet<(RobotId, RobotId, usize)>,
    /// By pair, step and round.
    cuts: HashMap<(RobotId, RobotId, usize, usize), Vec<f64>>,
    /// Links that are short enough along the axes, and along which other normals, as bits.
    ranges: HashSet<(Link, usize, Option<Vec<u64>>)>,
}

impl<'a> Encoder<'a> {
    /// An encoder with no position yet.
    pub fn new(
        problem: &'a Problem,
        abstraction: &'a Abstraction,
        reach: Box<dyn Reach + 'a>,
    ) -> Encoder<'a> {
        let mut circuit = Circuit::default();
        let switches = Switch::ALL.map(|_| circuit.define(Gate::Choice));
        Encoder {
            problem,
            abstraction,
            reach,
            eager: false,
            half_spaces: HalfSpaces::new(problem),
            temporal: Temporal::new(problem),
            circuit,
            links: Vec::new(),
            connected: Vec::new(),
            cells: abstraction.partition.as_ref().map(CellVariables::new),
            lasts: Vec::new(),
            loops: Vec::new(),
            switches,
            deferred: HashMap::new(),
            atoms: HashMap::new(),
            clears: HashMap::new(),
            passages: HashMap::new(),
            access: HashMap::new(),
            apart: HashSet::new(),
            cuts: HashMap::new(),
            ranges: HashSet::new(),
        }
    }

    /// Encodes the positions up to a length and closes its loops. Lengths come in rising order.
    pub fn extend(&mut self, length: usize) {
        while self.lasts.len() <= length {
            self.add_position();
        }
        // A length that is never tried is none.
        for skipped in self.loops.len()..length {
            self.refute(skipped);
        }
        let last = self.lasts[length];
        let loops: Vec<Lit> = (0..=length).map(|_| self.circuit.define(Gate::Choice)).collect();
        for &back in &loops {
            self.circuit.clause(&[!back, last]);
        }
        self.extend_cells(length + 1);
        self.close_cells(length, &loops);
        self.connect_loops(length, &loops);
        let mut some: Vec<Lit> = vec![!last];
        some.extend(&loops);
        self.circuit.clause(&some);
        self.temporal.close(&mut self.circuit, last, &loops);
        self.loops.resize(length, Vec::new());
        self.loops.push(loops);
    }

    fn add_position(&mut self) {
        let step = self.lasts.len();
        let last = self.circuit.define(Gate::Choice);
        if self.problem.connectivity.is_some() {
            self.add_links(step);
            self.extend_cells(step);
            self.extend_sight(step);
        }
        self.extend_cells(step);
        let was_last = self.lasts.last().copied();
        self.lasts.push(last);
        let asks = self.temporal.asks();
        let answers: Vec<Bit> = asks.into_iter().map(|ask| self.answer(ask, step)).collect();
        let goals = self.temporal.extend(&mut self.circuit, was_last, &answers);
        for goal in goals {
            self.circuit.require(goal);
        }
    }

    fn answer(&mut self, ask: Ask, step: usize) -> Bit {
        match ask {
            Ask::In(robot, region) => self.atom(robot, region, step).0,
            Ask::Out(robot, region) => self.atom(robot, region, step).1,
            Ask::Compare(comparison) => self.compare(&comparison, step),
        }
    }

    fn compare(&mut self, comparison: &Comparison, step: usize) -> Bit {
        let atoms: Vec<(Bit, Bit)> =
            comparison.terms.iter().map(|(atom, _)| self.atom(atom.robot, atom.region, step)).collect();
        compare::compare(&mut self.circuit, comparison, &atoms)
    }

    /// 'Certainly in' and 'certainly out'.
    fn atom(&mut self, robot: RobotId, region: RegionId, step: usize) -> (Bit, Bit) {
        if let Some(&bits) = self.atoms.get(&(robot, region, step)) {
            return bits;
        }
        if let Some(bits) = self.cell_labels(robot, region, step) {
            self.atoms.insert((robot, region, step), bits);
            return bits;
        }
        let model = self.problem.robots[robot].model;
        let mut pieces = Vec::new();
        for facets in self.abstraction.inside(model, region) {
            if !self.accessible(robot, region, pieces.len(), &facets) {
                pieces.push(Bit::False);
                continue;
            }
            let rows: Vec<Bit> = facets.iter().map(|f| self.half_space(robot, step, *f)).collect();
            pieces.push(self.circuit.and(rows));
        }
        let inside = self.circuit.or(pieces);
        let solids: Vec<SolidId> = self.abstraction.solids_of(Owner::Region(region)).collect();
        let clear: Vec<Bit> = solids.iter().map(|&s| self.clear(s, vec![End::Robot(robot, step)])).collect();
        let outside = self.circuit.and(clear);
        self.atoms.insert((robot, region, step), (inside, outside));
        (inside, outside)
    }

    /// Whether a robot can get from its start to a piece of a region at all.
    fn accessible(&mut self, robot: RobotId, region: RegionId, piece: usize, facets: &[HalfSpace]) -> bool {
        let (problem, abstraction) = (self.problem, self.abstraction);
        let entry = &problem.robots[robot];
        let passage =
            self.passages.entry(entry.model).or_insert_with(|| Passage::new(abstraction, entry.model));
        let Some(passage) = passage else { return true };
        *self.access.entry((robot, region, piece)).or_insert_with(|| {
            let position = &problem.models[entry.model].position;
            let start: Vec<f64> = position.iter().map(|&s| entry.start[s].to_f64()).collect();
            passage.connects(abstraction, &start, facets)
        })
    }

    fn half_space(&mut self, robot: RobotId, step: usize, half_space: HalfSpace) -> Bit {
        let (abstraction, problem) = (self.abstraction, self.problem);
        let at = (robot, step, half_space);
        self.half_spaces.literal(&mut self.circuit, abstraction, problem, &mut *self.reach, at)
    }

    /// Some direction along which the hull of all ends lies below the solid.
    fn clear(&mut self, solid: SolidId, ends: Vec<End>) -> Bit {
        if let Some(&bit) = self.clears.get(&(solid, ends.clone())) {
            return bit;
        }
        let bit = self.clear_from(Stage::Facets, solid, &ends);
        self.clears.insert((solid, ends), bit);
        bit
    }

    /// The disjunction over a stage's directions and whatever later stages bring; over those of all
    /// stages when eager.
    fn clear_from(&mut self, stage: Stage, solid: SolidId, ends: &[End]) -> Bit {
        let (faces, eager) = (&self.abstraction.solids[solid].faces, self.eager);
        let mut sides = Vec::new();
        for &(_, direction) in faces.iter().filter(|(s, _)| eager || *s == stage) {
            let rows: Vec<Bit> = ends.iter().map(|end| self.below(*end, solid, direction)).collect();
            sides.push(self.circuit.and(rows));
        }
        let later = faces.iter().map(|(s, _)| *s).filter(|s| !eager && *s > stage).min();
        if let Some(later) = later {
            sides.push(self.defer(Deferred::Clear(later, solid, ends.to_vec())));
        }
        self.circuit.or(sides)
    }

    fn below(&mut self, end: End, solid: SolidId, direction: crate::abstraction::DirectionId) -> Bit {
        match end {
            End::Robot(robot, step) => {
                let model = self.problem.robots[robot].model;
                let half_space = self.abstraction.below(model, solid, direction);
                self.half_space(robot, step, half_space)
            }
            End::Base(base) => {
                let point = self.abstraction.base(base);
                Bit::from(self.abstraction.point_below(point, solid, direction))
            }
        }
    }

    fn defer(&mut self, what: Deferred) -> Bit {
        let switch = match &what {
            Deferred::Clear(Stage::Oblique, ..) => Switch::Oblique,
            Deferred::Clear(..) => Switch::Tangents,
            Deferred::Apart(..) => Switch::Coupled,
        };
        let lit = self.circuit.deferred_or(self.switches[switch as usize]);
        self.deferred.insert(what, lit);
        Bit::Lit(lit)
    }

    /// Gives a deferred disjunct its meaning. False when it has one already.
    fn define(&mut self, what: Deferred) -> bool {
        let Some(lit) = self.deferred.remove(&what) else { return false };
        let bit = match what {
            Deferred::Clear(stage, solid, ends) => self.clear_from(stage, solid, &ends),
            Deferred::Apart(first, second, step, _) => self.faces(first, second, step),
        };
        self.circuit.resolve(lit, bit);
        true
    }

    /// Gives the first disjunct that a demand still leaves open its meaning, if there is one.
    fn define_clear(&mut self, solid: SolidId, ends: &[End]) -> bool {
        let stages = [Stage::Tangents, Stage::Oblique];
        stages.into_iter().any(|stage| self.define(Deferred::Clear(stage, solid, ends.to_vec())))
    }

    /// Says more of what a [clear move](Encoder::demand_clear_move) takes. False when all is said.
    pub fn sharpen_move(&mut self, robot: RobotId, step: usize, solid: SolidId) -> bool {
        self.define_clear(solid, &[End::Robot(robot, step), End::Robot(robot, step + 1)])
    }

    /// Says more of what a [clear link](Encoder::demand_clear_link) takes. False when all is said.
    pub fn sharpen_link(&mut self, link: Link, step: usize, solid: SolidId) -> bool {
        self.define_clear(solid, &link_ends(link, step))
    }

    /// Says more of what it takes to [keep apart](Encoder::demand_apart): other cuts at first, then
    /// constraints on both robots at once. False when all is said.
    pub fn sharpen_apart(
        &mut self,
        first: RobotId,
        second: RobotId,
        step: usize,
        cuts: [Vec<f64>; 2],
    ) -> bool {
        let rounds =
            (1..CUTS).find(|&r| self.deferred.contains_key(&Deferred::Apart(first, second, step, r)));
        let Some(round) = rounds else { return self.define(Deferred::Apart(first, second, step, CUTS)) };
        let Some(lit) = self.deferred.remove(&Deferred::Apart(first, second, step, round)) else {
            return false;
        };
        let sides = self.cut_sides(first, second, step, cuts, round);
        self.circuit.resolve(lit, sides);
        true
    }

    /// The literal that lets a switch be used; assume its negation to keep it off. While what is
    /// behind a switch that is on has no meaning yet, it counts as true.
    pub fn switch(&self, switch: Switch) -> Lit {
        self.switches[switch as usize]
    }

    /// Demands that a robot's move from a step to the next keeps clear of a solid.
    pub fn demand_clear_move(&mut self, robot: RobotId, step: usize, solid: SolidId) {
        let bit = self.clear(solid, vec![End::Robot(robot, step), End::Robot(robot, step + 1)]);
        self.circuit.require(bit);
    }

    /// Demands that a link at a step, if it is used, keeps clear of a solid.
    pub fn demand_clear_link(&mut self, link: Link, step: usize, solid: SolidId) {
        let ends = link_ends(link, step).to_vec();
        let bit = self.clear(solid, ends);
        let lit = self.links[step].literal(link);
        self.circuit.grow(lit, bit);
    }

    /// Demands that two robots keep apart during a step.
    ///
    /// `cuts` are coordinates, one an axis, for each end of the step: the robots may stay on
    /// different sides of them, which takes no constraint on both at once. The first cuts that a
    /// pair and a step get are kept.
    pub fn demand_apart(&mut self, first: RobotId, second: RobotId, step: usize, cuts: [Vec<f64>; 2]) {
        if !self.apart.insert((first, second, step)) {
            return;
        }
        let bit = self.cut_sides(first, second, step, cuts, 0);
        self.circuit.require(bit);
    }

    /// Both robots on different sides of the cuts of a round, or what the next round brings.
    fn cut_sides(
        &mut self,
        first: RobotId,
        second: RobotId,
        step: usize,
        cuts: [Vec<f64>; 2],
        round: usize,
    ) -> Bit {
        for (at, cut) in cuts.into_iter().enumerate() {
            self.cuts.entry((first, second, step + at, round)).or_insert(cut);
        }
        let mut sides = Vec::new();
        for axis in 0..self.problem.dimension {
            for positive in [true, false] {
                let face = Face { first, second, step, axis, positive };
                let here = self.cut(face, round);
                let there = self.cut(Face { step: step + 1, ..face }, round);
                sides.push(self.circuit.and([here, there]));
            }
        }
        sides.push(self.defer(Deferred::Apart(first, second, step, round + 1)));
        self.circuit.or(sides)
    }

    /// Both robots on their sides of the cut, at the face's step alone.
    fn cut(&mut self, face: Face, round: usize) -> Bit {
        let half = 0.5 * self.problem.separation.as_ref().map_or(0.0, |e| e.to_f64());
        let cut = self.cuts[&(face.first, face.second, face.step, round)][face.axis];
        let (above, below) =
            if face.positive { (face.first, face.second) } else { (face.second, face.first) };
        let mut side = |robot: RobotId, downwards: bool| {
            let direction = self.abstraction.directions.axis(face.axis, downwards);
            let model = self.problem.robots[robot].model;
            let inset = half + self.abstraction.support(model, direction) + 0.5 * self.abstraction.gap;
            let level = if downwards { cut } else { -cut };
            self.half_space(robot, face.step, HalfSpace { direction, offset: level - inset })
        };
        let bits = [side(above, false), side(below, true)];
        self.circuit.and(bits)
    }

    fn faces(&mut self, first: RobotId, second: RobotId, step: usize) -> Bit {
        let mut faces = Vec::new();
        for axis in 0..self.problem.dimension {
            for positive in [true, false] {
                let face = Face { first, second, step, axis, positive };
                faces.push(Bit::Lit(self.circuit.define(Gate::Leaf(Leaf::Apart(face)))));
            }
        }
        self.circuit.or(faces)
    }

    /// Adds a lemma: these leaves can't all be true, with this loop if one is named.
    pub fn learn(&mut self, leaves: &[Lit], lasso: Option<(usize, usize)>) {
        let mut clause: Vec<Lit> = leaves.iter().map(|l| !*l).collect();
        clause.extend(lasso.map(|(length, back)| !self.loops[length][back]));
        self.circuit.clause(&clause);
    }

    /// Hands the clauses written since the last call to a solver or a file.
    ///
    /// # Errors
    /// When the collector's memory runs out.
    pub fn write_clauses(&mut self, collector: &mut impl CollectClauses) -> Result<(), OutOfMemory> {
        self.circuit.write_clauses(collector)
    }

    /// The literal 'this position is the last one'.
    pub fn last(&self, length: usize) -> Lit {
        self.lasts[length]
    }

    /// Rules a length out for good.
    pub fn refute(&mut self, length: usize) {
        self.circuit.clause(&[!self.lasts[length]]);
    }

    /// Where the loop of a model goes back to.
    pub fn loop_start(&self, truth: &dyn Fn(Lit) -> bool, length: usize) -> Option<usize> {
        self.loops[length].iter().position(|&l| truth(l))
    }

    /// The leaves that a model's truth rests on.
    pub fn justify(&self, truth: &dyn Fn(Lit) -> bool, length: usize, back: usize) -> Justification {
        let (leaves, seen) = justify::justify(&self.circuit, truth, length, back);
        let used = |step: usize| -> Vec<Link> {
            let links = self.links.get(step).into_iter().flat_map(StepLinks::iter);
            links.filter(|(_, lit)| seen[lit.vidx()]).map(|(link, _)| link).collect()
        };
        let links = (0..=length).map(used).collect();
        let leaf = |lit: Lit| match self.circuit.gate(lit) {
            Gate::Leaf(leaf) => Some((lit, *leaf)),
            _ => None,
        };
        Justification { leaves: leaves.into_iter().filter_map(leaf).collect(), links }
    }

    /// The half-space literals along a direction, offsets rising.
    pub fn parallel(&self, robot: RobotId, step: usize, half_space: HalfSpace) -> &[(f64, Lit)] {
        self.half_spaces.along(robot, step, half_space.direction)
    }

    /// Whether a definition had to be strengthened, so that a refutation says nothing.
    pub fn is_incomplete(&self) -> bool {
        self.circuit.is_incomplete()
    }

    /// Counts for reports.
    pub fn counts(&self) -> Counts {
        Counts {
            half_spaces: self.half_spaces.len(),
            variables: self.circuit.variables(),
            connectivity: self.links.iter().map(|l| l.variables).sum(),
            clauses: self.circuit.clauses(),
        }
    }
}

fn link_ends(link: Link, step: usize) -> [End; 2] {
    match link {
        Link::Robots(a, b) => [End::Robot(a, step), End::Robot(b, step)],
        Link::Base(robot, base) => [End::Robot(robot, step), End::Base(base)],
    }
}

/// What a model's truth rests on.
#[derive(Clone, Debug)]
pub struct Justification {
    /// The constraints of the convex part, with their literals.
    pub leaves: Vec<(Lit, Leaf)>,
    /// By step: the links in use.
    pub links: Vec<Vec<Link>>,
}
