//! The states and inputs of a motion model, as its tokens give them.

use crate::syntax::words::COORDINATES;

/// The names of a position and its derivatives, with their units.
const CHAIN: [(&str, &str); 5] = [("p", "m"), ("v", "m/s"), ("a", "m/s^2"), ("j", "m/s^3"), ("s", "m/s^4")];

/// A state or an input.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Signal<'t> {
    pub(super) name: std::borrow::Cow<'t, str>,
    pub(super) unit: &'t str,
    pub(super) is_input: bool,
}

/// A motion model, as far as it was read.
#[derive(Clone, Default, Debug)]
pub(super) struct Model<'t> {
    /// The signals that are declared, in their order.
    pub(super) signals: Vec<Signal<'t>>,
    /// The order of its integrators.
    pub(super) order: Option<usize>,
}

impl<'t> Model<'t> {
    /// All signals, with those of `integrator` in a workspace of some dimensions.
    pub(super) fn all(&self, dimensions: usize) -> Vec<Signal<'t>> {
        let mut signals = self.signals.clone();
        let order = self.order.map_or(0, |order| order.min(CHAIN.len() - 1));
        let chain = &CHAIN[..if self.order.is_some() { order + 1 } else { 0 }];
        for axis in &COORDINATES[..dimensions.min(COORDINATES.len())] {
            for (derivative, (letter, unit)) in chain.iter().enumerate() {
                let name = format!("{letter}{axis}").into();
                signals.push(Signal { name, unit, is_input: derivative == order });
            }
        }
        // States come first, as everywhere.
        signals.sort_by_key(|signal| signal.is_input);
        signals
    }

    /// The unit of a signal.
    pub(super) fn unit(&self, name: &str) -> Option<&'t str> {
        let declared = self.signals.iter().find(|signal| signal.name == name).map(|signal| signal.unit);
        declared.or_else(|| {
            let of_chain = |(letter, _): &&(&str, &str)| {
                let axis = name.strip_prefix(letter);
                axis.is_some_and(|axis| COORDINATES.contains(&axis))
            };
            self.order.and_then(|_| CHAIN.iter().find(of_chain)).map(|(_, unit)| *unit)
        })
    }
}
