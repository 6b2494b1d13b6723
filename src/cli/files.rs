//! Reading missions and plans, and writing results whole or not at all.

use std::fs::{self, File};
use std::io::{self, BufWriter, Read, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::output::plain_error;
use crate::back::Artifact;
use crate::diag::{Diagnostic, printable};

/// The largest file that is read; no mission or plan comes near it.
const LARGEST: u64 = 256 << 20;

/// The name by which standard input is called.
pub const STDIN: &str = "<stdin>";

/// The name that messages call a path by.
pub fn shown_name(path: &Path) -> String {
    if path == Path::new("-") { STDIN.into() } else { path.to_string_lossy().into_owned() }
}

/// The bytes of a file, or of standard input for `-`.
///
/// # Errors
/// A diagnostic that names the file and why it can't be read.
pub fn read(path: &Path) -> Result<Vec<u8>, Diagnostic> {
    let bytes = if path == Path::new("-") { read_some(io::stdin().lock()) } else { read_file(path) };
    let bytes = bytes.map_err(|e| unreadable(path, &reason(&e)))?;
    if bytes.len() as u64 > LARGEST {
        return Err(unreadable(path, "it is larger than 256 MiB"));
    }
    Ok(bytes)
}

fn read_file(path: &Path) -> io::Result<Vec<u8>> {
    if path.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    read_some(File::open(path)?)
}

/// All that a reader gives, up to just more than the largest file allowed.
fn read_some(reader: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    reader.take(LARGEST + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn unreadable(path: &Path, why: &str) -> Diagnostic {
    plain_error("dosm::cli::unreadable", format!("can't read `{}`: {why}", printable(&shown_name(path))))
}

fn unwritable(path: &Path, error: &io::Error) -> Diagnostic {
    let name = path.to_string_lossy();
    plain_error("dosm::cli::unwritable", format!("can't write `{}`: {}", printable(&name), reason(error)))
}

/// Why, in a few words.
fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "there is no such file or directory".into(),
        io::ErrorKind::PermissionDenied => "permission denied".into(),
        io::ErrorKind::IsADirectory => "it is a directory".into(),
        io::ErrorKind::NotADirectory => "a part of its path is no directory".into(),
        io::ErrorKind::AlreadyExists => "it is there already".into(),
        io::ErrorKind::StorageFull => "the disk is full".into(),
        _ => error.to_string(),
    }
}

/// A directory that results go to; looked at before the work, created when there is something to put
/// there.
pub struct OutputDirectory {
    path: PathBuf,
}

impl OutputDirectory {
    /// Sees whether the directory can be written to, or created where it is to be.
    ///
    /// # Errors
    /// A diagnostic when it can't.
    pub fn probe(path: &Path) -> Result<OutputDirectory, Diagnostic> {
        // The nearest place that is there already decides.
        let there = path.ancestors().find(|a| a.exists()).unwrap_or(Path::new("."));
        temporary_in(there).map_err(|e| unwritable(path, &e))?;
        Ok(OutputDirectory { path: path.into() })
    }

    /// Writes all artifacts, or none; they appear in the order given, each at once.
    ///
    /// # Errors
    /// A diagnostic when one can't be written.
    pub fn write(&self, artifacts: &[Artifact]) -> Result<Vec<PathBuf>, Diagnostic> {
        let files: Vec<_> = artifacts.iter().map(|a| (a.name.as_str(), a.contents.as_bytes())).collect();
        self.write_bytes(&files)
    }

    /// Writes all files, given by name and contents, or none; they appear in the order given, each at
    /// once.
    ///
    /// # Errors
    /// A diagnostic when one can't be written.
    pub fn write_bytes(&self, files: &[(&str, &[u8])]) -> Result<Vec<PathBuf>, Diagnostic> {
        fs::create_dir_all(&self.path).map_err(|e| unwritable(&self.path, &e))?;
        let mut ready = Vec::new();
        for (name, contents) in files {
            let path = self.path.join(name);
            // A name may lead into directories below.
            let parent = path.parent().unwrap_or(&self.path);
            fs::create_dir_all(parent).map_err(|e| unwritable(parent, &e))?;
            let file = self.filled(contents).map_err(|e| unwritable(&path, &e))?;
            ready.push((path, file));
        }
        sync_all(&ready)?;
        let mut written = Vec::new();
        for (path, file) in ready {
            file.persist(&path).map_err(|e| unwritable(&path, &e.error))?;
            written.push(path);
        }
        self.sync();
        Ok(written)
    }

    /// A temporary file with some contents.
    fn filled(&self, contents: &[u8]) -> io::Result<NamedTempFile> {
        let mut file = temporary_in(&self.path)?;
        file.write_all(contents)?;
        Ok(file)
    }

    /// Makes the renames last, where directories can be synced.
    fn sync(&self) {
        if let Ok(directory) = File::open(&self.path) {
            let _ = directory.sync_all();
        }
    }
}

/// Waits until the contents of all files are on the disk. They go there together: one after the other
/// takes longer than many a search.
fn sync_all(files: &[(PathBuf, NamedTempFile)]) -> Result<(), Diagnostic> {
    let sync =
        |(path, file): &(PathBuf, NamedTempFile)| file.as_file().sync_all().map_err(|e| unwritable(path, &e));
    std::thread::scope(|scope| {
        let syncs: Vec<_> = files.iter().map(|file| scope.spawn(move || sync(file))).collect();
        syncs.into_iter().try_for_each(|sync| sync.join().unwrap_or(Ok(())))
    })
}

/// A single file that a result goes to; looked at before the work.
pub struct OutputFile {
    directory: OutputDirectory,
    name: String,
}

impl OutputFile {
    /// Sees whether the file can be written.
    ///
    /// # Errors
    /// A diagnostic when it can't.
    pub fn probe(path: &Path) -> Result<OutputFile, Diagnostic> {
        let name = path.file_name().and_then(|name| name.to_str());
        let Some(name) = name.filter(|_| !path.is_dir()) else {
            return Err(unwritable(path, &io::ErrorKind::IsADirectory.into()));
        };
        let parent = path.parent().unwrap_or(Path::new(""));
        Ok(OutputFile { directory: OutputDirectory::probe(parent)?, name: name.into() })
    }

    /// Writes the file, or nothing; what was there before is replaced at once.
    ///
    /// # Errors
    /// A diagnostic when it can't be written.
    pub fn write(&self, contents: &[u8]) -> Result<PathBuf, Diagnostic> {
        let mut written = self.directory.write_bytes(&[(&self.name, contents)])?;
        Ok(written.pop().unwrap_or_default())
    }
}

impl OutputFile {
    /// Begins a file that grows bit by bit and is not there before it is finished.
    ///
    /// # Errors
    /// A diagnostic when it can't be written.
    pub fn begin(&self) -> Result<GrowingFile<'_>, Diagnostic> {
        let path = self.directory.path.join(&self.name);
        fs::create_dir_all(&self.directory.path).map_err(|e| unwritable(&path, &e))?;
        let file = temporary_in(&self.directory.path).map_err(|e| unwritable(&path, &e))?;
        Ok(GrowingFile { of: self, path, file: BufWriter::new(file) })
    }
}

/// A file that is not there before it is whole.
pub struct GrowingFile<'a> {
    of: &'a OutputFile,
    path: PathBuf,
    file: BufWriter<NamedTempFile>,
}

impl GrowingFile<'_> {
    /// Adds to it.
    ///
    /// # Errors
    /// A diagnostic when it can't be written.
    pub fn add(&mut self, text: &str) -> Result<(), Diagnostic> {
        self.file.write_all(text.as_bytes()).map_err(|e| unwritable(&self.path, &e))
    }

    /// Puts it in its place; what was there before is replaced at once.
    ///
    /// # Errors
    /// A diagnostic when it can't be written.
    pub fn finish(self) -> Result<PathBuf, Diagnostic> {
        let path = self.path;
        let file = self.file.into_inner().map_err(|e| unwritable(&path, e.error()))?;
        file.as_file().sync_all().map_err(|e| unwritable(&path, &e))?;
        file.persist(&path).map_err(|e| unwritable(&path, &e.error))?;
        self.of.directory.sync();
        Ok(path)
    }
}

/// A temporary file beside the results, so that a rename puts it in place.
fn temporary_in(directory: &Path) -> io::Result<NamedTempFile> {
    // An empty path stands for the current directory.
    let directory = if directory.as_os_str().is_empty() { Path::new(".") } else { directory };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".dosmc-");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(directory)
}

/// Replaces a file's contents at once, or leaves it as it is; it keeps its place and its permissions.
///
/// # Errors
/// A diagnostic when it can't be written.
pub fn replace(path: &Path, contents: &[u8]) -> Result<(), Diagnostic> {
    let replaced = || {
        // A link stays one: what it leads to is replaced.
        let path = path.canonicalize()?;
        let permissions = path.metadata()?.permissions();
        if permissions.readonly() {
            return Err(io::ErrorKind::PermissionDenied.into());
        }
        let mut file = temporary_in(path.parent().unwrap_or(Path::new("")))?;
        file.write_all(contents)?;
        file.as_file().set_permissions(permissions)?;
        file.as_file().sync_all()?;
        file.persist(&path).map_err(|e| e.error)
    };
    replaced().map(drop).map_err(|e| unwritable(path, &e))
}

/// Writes a new file; one that is there is left alone.
///
/// # Errors
/// A diagnostic when it is there already or can't be written.
pub fn create(path: &Path, contents: &str) -> Result<(), Diagnostic> {
    let mut file = File::create_new(path).map_err(|e| unwritable(path, &e))?;
    file.write_all(contents.as_bytes()).map_err(|e| {
        // A half-written file is worse than none.
        let _ = fs::remove_file(path);
        unwritable(path, &e)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn artifact(name: &str, contents: &str) -> Artifact {
        Artifact { name: name.into(), contents: contents.into() }
    }

    #[test]
    fn a_failed_write_changes_nothing() {
        let dir = tempfile::tempdir().expect("a directory");
        let path = dir.path().join("a/b");
        let out = OutputDirectory::probe(&path).expect("it can be made");
        assert!(!dir.path().join("a").exists(), "looking creates nothing");
        out.write(&[artifact("plan.svg", "old"), artifact("plan.json", "old")]).expect("it can be written");
        fs::create_dir(path.join("taken")).expect("a directory in the way");
        assert!(out.write(&[artifact("taken", "new"), artifact("plan.json", "new")]).is_err());
        assert_eq!(fs::read_to_string(path.join("plan.json")).expect("it is there"), "old");
        assert_eq!(fs::read_dir(&path).expect("it is there").count(), 3, "no temporary file stays");
    }

    #[test]
    fn a_place_that_is_no_directory_is_refused_at_once() {
        let dir = tempfile::tempdir().expect("a directory");
        fs::write(dir.path().join("file"), "").expect("it can be written");
        assert!(OutputDirectory::probe(&dir.path().join("file")).is_err());
        assert!(OutputDirectory::probe(&dir.path().join("file/below")).is_err());
    }
}
