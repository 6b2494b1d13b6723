//! What every picture has to be: XML with nothing in it but drawing, and texts that do not lie on
//! each other. Widths are Helvetica's own here, not the bound that the product reckons with.

use roxmltree::{Document, Node};

/// The elements that pictures are made of.
const ELEMENTS: [&str; 10] =
    ["svg", "title", "desc", "defs", "pattern", "rect", "path", "style", "text", "g"];

/// Helvetica's widths from the space to the tilde, in thousandths of an em.
const REGULAR: [u16; 95] = [
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556, 556, 556,
    556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667, 611, 778, 722, 278,
    500, 667, 556, 833, 722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469,
    556, 333, 556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556, 556, 556, 333, 500,
    278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584,
];
/// The same for the bold face.
const BOLD: [u16; 95] = [
    278, 333, 474, 556, 556, 889, 722, 238, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556, 556, 556,
    556, 556, 556, 556, 556, 333, 333, 584, 584, 584, 611, 975, 722, 722, 722, 722, 667, 611, 778, 722, 278,
    556, 722, 611, 833, 722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 333, 278, 333, 584,
    556, 333, 556, 611, 556, 611, 556, 333, 611, 611, 278, 278, 556, 278, 889, 611, 611, 611, 611, 389, 556,
    333, 611, 556, 778, 556, 556, 500, 389, 280, 389, 584,
];

/// A text as it is drawn: what it says, and its box (left, top, right, bottom) in pixels.
pub struct Label {
    /// What it says.
    pub text: String,
    /// Where it is.
    pub bounds: [f64; 4],
}

/// Fails when a text is no picture as pictures have to be.
pub fn assert_fine(svg: &str) {
    let document = Document::parse(svg).unwrap_or_else(|e| panic!("no XML: {e}"));
    for node in document.descendants().filter(Node::is_element) {
        let name = node.tag_name().name();
        assert!(ELEMENTS.contains(&name), "<{name}> is nothing to draw with");
        for attribute in node.attributes() {
            assert!(!attribute.name().starts_with("on") && attribute.name() != "href", "{attribute:?}");
        }
    }
    let turns = |c| matches!(c, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let hostile = |c: char| turns(c) || (c.is_control() && c != '\n');
    assert!(!svg.contains(hostile), "a character that is not shown as itself");
    let size =
        |name: &str| document.root_element().attribute(name).and_then(|v| v.parse().ok()).unwrap_or(0.0);
    assert_apart(&labels(&document), [size("width"), size("height")]);
}

/// All texts of a picture; halos lie under texts and are left out.
pub fn labels(document: &Document) -> Vec<Label> {
    let texts = document.descendants().filter(|n| n.has_tag_name(("http://www.w3.org/2000/svg", "text")));
    texts.filter(|n| !class(n).contains(&"halo")).map(|n| label(&n)).collect()
}

fn class<'a>(node: &Node<'a, '_>) -> Vec<&'a str> {
    node.attribute("class").unwrap_or_default().split(' ').collect()
}

fn label(node: &Node) -> Label {
    let class = class(node);
    let has = |name: &str| class.contains(&name);
    let size = match () {
        () if has("title") => 20.0,
        () if has("sub") || has("tick") || has("step") => 13.0,
        () => 15.0,
    };
    let widths = if has("title") || has("name") { &BOLD } else { &REGULAR };
    let text = node.text().unwrap_or_default().to_string();
    let advance = |c: char| match c {
        ' '..='~' => f64::from(widths[c as usize - 32]) / 1000.0,
        _ => 1.0,
    };
    let width = size * text.chars().map(advance).sum::<f64>();
    let at = |name: &str| node.attribute(name).and_then(|v| v.parse::<f64>().ok()).expect("a number");
    let left = at("x")
        - if has("mid") {
            width / 2.0
        } else if has("end") {
            width
        } else {
            0.0
        };
    // From the baseline up to the capitals, and down to the descenders.
    Label { text, bounds: [left, at("y") - 0.72 * size, left + width, at("y") + 0.15 * size] }
}

fn assert_apart(labels: &[Label], [width, height]: [f64; 2]) {
    assert!(labels.len() > 5, "hardly any text");
    for (i, label) in labels.iter().enumerate() {
        let [left, top, right, bottom] = label.bounds;
        let inside = left >= 0.0 && top >= 0.0 && right <= width && bottom <= height;
        assert!(inside, "`{}` leaves the picture: {:?}", label.text, label.bounds);
        for other in &labels[..i] {
            let b = other.bounds;
            let apart = right <= b[0] || b[2] <= left || bottom <= b[1] || b[3] <= top;
            assert!(apart, "`{}` lies on `{}`: {:?}, {b:?}", label.text, other.text, label.bounds);
        }
    }
}
