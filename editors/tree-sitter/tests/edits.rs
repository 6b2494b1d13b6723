//! A tree that is brought up to date after an edit is the tree of the new text.

mod common;

use common::{missions, parser};
use tree_sitter::{InputEdit, Node, Point, Tree};

/// Edits of each mission.
const EDITS: usize = 12;

/// What edits put in: pieces that change how what follows is read.
const PIECES: [&str; 24] = [
    " ",
    "\n",
    "/*",
    "*/",
    "//",
    "/// x\n",
    "goal g: ",
    "in",
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    " or ",
    " m/s",
    "1",
    ".",
    ";",
    "-> ",
    "<",
    "always[1, 2] ",
    "count(r in all: r in a)",
    "region é = ",
];

/// Numbers in an order without pattern (xorshift).
struct Dice(u64);

impl Dice {
    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % limit.max(1) as u64) as usize
    }
}

fn point(text: &str, at: usize) -> Point {
    let before = &text[..at];
    let line = before.rfind('\n').map_or(0, |end| end + 1);
    Point { row: before.matches('\n').count(), column: at - line }
}

/// A place between two characters.
fn place(dice: &mut Dice, text: &str) -> usize {
    let mut at = dice.below(text.len() + 1);
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

/// Puts a piece in place of a part of a text, and tells the tree; gives what stood there.
fn replace(text: &mut String, tree: &mut Tree, start: usize, old_end: usize, piece: &str) -> String {
    let (start_position, old_end_position) = (point(text, start), point(text, old_end));
    let before = text[start..old_end].to_owned();
    text.replace_range(start..old_end, piece);
    let new_end = start + piece.len();
    tree.edit(&InputEdit {
        start_byte: start,
        old_end_byte: old_end,
        new_end_byte: new_end,
        start_position,
        old_end_position,
        new_end_position: point(text, new_end),
    });
    before
}

/// A part of a text, and what could stand there.
fn edit(dice: &mut Dice, text: &str) -> (usize, usize, &'static str) {
    let start = place(dice, text);
    let mut end = (start + dice.below(12)).min(text.len());
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    (start, end, if dice.below(3) == 0 { "" } else { PIECES[dice.below(PIECES.len())] })
}

/// All nodes, signs too, with their places.
fn nodes(node: Node, out: &mut Vec<(String, usize, usize)>) {
    let (start, end) = (node.start_byte(), node.end_byte());
    out.push((node.kind().to_owned(), start, end));
    for i in 0..node.child_count() {
        nodes(node.child(i as u32).expect("a child"), out);
    }
}

fn all_nodes(tree: &Tree) -> Vec<(String, usize, usize)> {
    let mut out = Vec::new();
    nodes(tree.root_node(), &mut out);
    out
}

#[test]
fn trees_after_edits_are_those_of_the_text() {
    let mut parser = parser();
    let mut dice = Dice(0x9e37_79b9_7f4a_7c15);
    let (mut whole, mut broken) = (0, 0);
    for mission in missions() {
        let Ok(mut text) = String::from_utf8(mission.bytes) else { continue };
        let mut tree = parser.parse(&text, None).expect("no limit");
        let original = (tree.root_node().has_error(), all_nodes(&tree));
        for _ in 0..EDITS {
            let (start, end, piece) = edit(&mut dice, &text);
            let before = replace(&mut text, &mut tree, start, end, piece);
            tree = parser.parse(&text, Some(&tree)).expect("no limit");
            let fresh = parser.parse(&text, None).expect("no limit");
            // How a broken text is mended may depend on what was there before.
            if fresh.root_node().has_error() {
                assert!(tree.root_node().has_error(), "{}:\n{text}", mission.path);
                broken += 1;
            } else {
                assert_eq!(all_nodes(&tree), all_nodes(&fresh), "{}:\n{text}", mission.path);
                whole += 1;
            }
            // And back: nothing of a broken text is left.
            replace(&mut text, &mut tree, start, start + piece.len(), &before);
            tree = parser.parse(&text, Some(&tree)).expect("no limit");
            assert!(original.0 || all_nodes(&tree) == original.1, "{}: {before} for {piece}", mission.path);
        }
    }
    assert!(whole > 400 && broken > 400, "{whole} whole, {broken} broken");
}
