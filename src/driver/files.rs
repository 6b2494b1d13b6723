//! Missions written as files for other programs, and instance files read back.

use super::{Encoding, Mission, Overrides};
use crate::abstraction::{Abstraction, Fineness, TooFine};
use crate::back::smc::Document;
use crate::back::{Artifact, Emit, cnf, ir, smc, smt2};
use crate::encode::{Instance, TooLarge};
use crate::source::SourceFile;

/// Writes a mission in one of the back ends' formats, for plans of one length or, without it, for what
/// the format is for: all lengths of the horizon (`smc`), or its first (`cnf`, `smt2`).
///
/// # Errors
/// [`NotWritten`] when the instance would be too large.
pub fn compile(
    mission: &Mission,
    source: &SourceFile,
    encoding: Encoding,
    emit: Emit,
    length: Option<usize>,
) -> Result<Artifact, NotWritten> {
    let problem = &mission.problem;
    let whole = length.map_or(problem.horizon, |length| (length, length));
    match emit {
        // The IR says the whole mission, whatever is to be planned of it.
        Emit::Ir => Ok(ir::write(problem)),
        Emit::Smc => Ok(smc::write(&document(mission, source, encoding, whole)?)),
        Emit::Cnf => {
            let (abstraction, instance) = instance(mission, encoding, (whole.0, whole.0))?;
            Ok(cnf::write(problem, &abstraction, &instance.assuming_first_length()))
        }
        Emit::Smt2 => {
            let (_, instance) = instance(mission, encoding, (whole.0, whole.0))?;
            Ok(smt2::write(problem, &instance.assuming_first_length()))
        }
    }
}

/// Why a mission has no file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotWritten {
    /// The instance would be too large.
    TooLarge(TooLarge),
    /// The partition would be too fine.
    TooFine(TooFine),
}

fn instance(
    mission: &Mission,
    encoding: Encoding,
    lengths: (usize, usize),
) -> Result<(Abstraction, Instance), NotWritten> {
    let Mission { problem, tubes, .. } = mission;
    let mut abstraction = Abstraction::new(problem, tubes, super::BACKOFFS[0]);
    if encoding == Encoding::Paper {
        abstraction = abstraction.with_cells(problem, Fineness::Coarse).map_err(NotWritten::TooFine)?;
    }
    let instance = Instance::new(problem, tubes, &abstraction, lengths).map_err(NotWritten::TooLarge)?;
    Ok((abstraction, instance))
}

fn document(
    mission: &Mission,
    source: &SourceFile,
    encoding: Encoding,
    lengths: (usize, usize),
) -> Result<Document, NotWritten> {
    let (abstraction, instance) = instance(mission, encoding, lengths)?;
    Ok(smc::document(&source.text, &mission.problem, &mission.tubes, &abstraction, &instance))
}

/// The mission that an instance file was made from.
#[derive(Clone, Debug)]
pub struct Reopened {
    /// Its text.
    pub source: SourceFile,
    /// Its parameters and the file's lengths.
    pub overrides: Overrides,
    /// The file's encoding.
    pub encoding: Encoding,
}

/// The mission that an instance file says it was made from.
///
/// Messages call it by the mission's name, as if its file were called so: a mission that names none
/// has its file's.
pub fn reopen(document: &Document) -> Reopened {
    let set = document.mission.set.iter().map(|(name, value)| (name.clone(), value.clone())).collect();
    let ends = document.lengths.first().zip(document.lengths.last());
    let horizon = ends.map(|(first, last)| (first.length, last.length));
    Reopened {
        source: SourceFile::new(format!("{}.dosm", document.mission.name), document.mission.source.clone()),
        overrides: Overrides { set, horizon, ..Overrides::default() },
        encoding: encoding_of(document),
    }
}

/// What a document that [`smc::read`] accepted speaks of.
fn encoding_of(document: &Document) -> Encoding {
    if document.encoding == smc::PAPER { Encoding::Paper } else { Encoding::HalfSpaces }
}

/// Whether a file is the instance of a mission, whatever program wrote it: everything is made again
/// and compared, so that what is planned is what the file says.
pub fn is_instance_of(document: &Document, mission: &Mission, source: &SourceFile) -> bool {
    let again = self::document(mission, source, encoding_of(document), mission.problem.horizon);
    again.is_ok_and(|again| Document { tool: document.tool.clone(), ..again } == *document)
}
