//! Pictures as PNG, for those who built dosmc with the feature `png`.

#[cfg(feature = "png")]
use super::output::plain_error;
use crate::diag::Diagnostic;

/// The file's name in the output directory.
pub const NAME: &str = "plan.png";

/// How many pixels of a PNG stand for one of the SVG.
#[cfg(feature = "png")]
const ZOOM: f32 = 2.0;

/// Whether PNGs can be written.
///
/// # Errors
/// A diagnostic that says how to get a dosmc that can.
pub fn available() -> Result<(), Diagnostic> {
    if cfg!(feature = "png") { Ok(()) } else { Err(unavailable()) }
}

fn unavailable() -> Diagnostic {
    super::usage("this dosmc was built without PNG pictures")
        .with_help("draw FILE.svg instead, or build dosmc with `cargo install --path . --features png`")
}

/// A picture as PNG, twice as many pixels as the SVG has.
///
/// # Errors
/// A diagnostic when this program can't, or no font is installed.
#[cfg(feature = "png")]
pub fn from_svg(text: &str) -> Result<Vec<u8>, Diagnostic> {
    use resvg::{tiny_skia, usvg};
    let wrong = |why: &str| plain_error("dosm::cli::unwritable", format!("can't draw a PNG: {why}"));
    let mut options = usvg::Options::default();
    options.fontdb_mut().load_system_fonts();
    if options.fontdb.is_empty() {
        return Err(
            wrong("no font is installed").with_help("install one, such as DejaVu Sans, or draw FILE.svg")
        );
    }
    let tree = usvg::Tree::from_str(text, &options).map_err(|e| wrong(&e.to_string()))?;
    let size = tree.size().to_int_size().scale_by(ZOOM).ok_or_else(|| wrong("it is too large"))?;
    let mut pixels =
        tiny_skia::Pixmap::new(size.width(), size.height()).ok_or_else(|| wrong("it is too large"))?;
    resvg::render(&tree, tiny_skia::Transform::from_scale(ZOOM, ZOOM), &mut pixels.as_mut());
    pixels.encode_png().map_err(|e| wrong(&e.to_string()))
}

/// A picture as PNG, which this program can't draw.
///
/// # Errors
/// Always.
#[cfg(not(feature = "png"))]
pub fn from_svg(_: &str) -> Result<Vec<u8>, Diagnostic> {
    Err(unavailable())
}
