// What a mission's grammar can only tell by looking ahead: reserved words, units, nested comments.
//
// There is no state: every token is read from its own text, so edits never leave anything behind.

#include "tree_sitter/parser.h"
#include "words.h"

#include <string.h>

// The order is that of `externals` in grammar.js; the reserved words follow.
enum Token { BLOCK_COMMENT, UNIT, UNIT_ONE, ERROR, FIRST_RESERVED };

// The longest name of the language; no word that matters here is longer.
#define MAX_WORD 64
// Comments nest at most so deep.
#define MAX_NESTING 256

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

static bool is_blank(int32_t c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

static bool is_digit(int32_t c) { return c >= '0' && c <= '9'; }

static bool is_letter(int32_t c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

static bool is_word_part(int32_t c) { return is_letter(c) || is_digit(c); }

static void take(TSLexer *lexer) { lexer->advance(lexer, false); }

static int find(const char *const *list, unsigned count, const char *word) {
  for (unsigned i = 0; i < count; i++) {
    if (strcmp(list[i], word) == 0) return (int)i;
  }
  return -1;
}

// Reads letters and digits; a word too long to be of interest is left as an empty one.
static void read_word(TSLexer *lexer, char word[MAX_WORD + 1]) {
  unsigned length = 0;
  while (is_word_part(lexer->lookahead)) {
    if (length < MAX_WORD) word[length] = (char)lexer->lookahead;
    length++;
    take(lexer);
  }
  word[length <= MAX_WORD ? length : 0] = '\0';
}

static bool scan_comment(TSLexer *lexer) {
  take(lexer);
  if (lexer->lookahead != '*') return false;
  take(lexer);
  unsigned depth = 1;
  while (depth > 0) {
    int32_t c = lexer->lookahead;
    if (lexer->eof(lexer)) return false;
    take(lexer);
    if (c == '/' && lexer->lookahead == '*') {
      take(lexer);
      if (++depth > MAX_NESTING) return false;
    } else if (c == '*' && lexer->lookahead == '/') {
      take(lexer);
      depth--;
    }
  }
  lexer->mark_end(lexer);
  lexer->result_symbol = BLOCK_COMMENT;
  return true;
}

// Whether the word is a unit's symbol; the lexer stands behind it. `min(` is the function.
static bool is_symbol(TSLexer *lexer, const char *word) {
  if (find(UNITS, COUNT(UNITS), word) < 0) return false;
  return strcmp(word, "min") != 0 || lexer->lookahead != '(';
}

// Reads `^2`, `*s`, `/s^-1` … and marks the end behind each whole one.
static void scan_unit_rest(TSLexer *lexer) {
  char word[MAX_WORD + 1];
  for (;;) {
    lexer->mark_end(lexer);
    if (lexer->lookahead == '^') {
      take(lexer);
      if (lexer->lookahead == '-') take(lexer);
      if (!is_digit(lexer->lookahead)) return;
      while (is_digit(lexer->lookahead)) take(lexer);
      lexer->mark_end(lexer);
    }
    if (lexer->lookahead != '*' && lexer->lookahead != '/') return;
    take(lexer);
    read_word(lexer, word);
    if (!is_symbol(lexer, word)) return;
  }
}

// Whether `min` and then blanks are followed by a bracket.
static bool is_call(TSLexer *lexer) {
  while (is_blank(lexer->lookahead)) take(lexer);
  return lexer->lookahead == '(';
}

static bool scan_word(TSLexer *lexer, const bool *valid) {
  char word[MAX_WORD + 1];
  read_word(lexer, word);
  int reserved = find(RESERVED, COUNT(RESERVED), word);
  if (reserved >= 0) {
    // Given out where it is not expected, too: the parser then knows that something is missing before it.
    lexer->mark_end(lexer);
    lexer->result_symbol = (TSSymbol)(FIRST_RESERVED + reserved);
    return true;
  }
  if (!valid[UNIT] || valid[ERROR] || !is_symbol(lexer, word)) return false;
  lexer->result_symbol = UNIT;
  if (strcmp(word, "min") == 0 && is_blank(lexer->lookahead)) {
    lexer->mark_end(lexer);
    return !is_call(lexer);
  }
  scan_unit_rest(lexer);
  return true;
}

// `1` alone, where a signal's unit stands, or before `/`.
static bool scan_one(TSLexer *lexer, const bool *valid) {
  char word[MAX_WORD + 1];
  take(lexer);
  if (is_word_part(lexer->lookahead) || lexer->lookahead == '.') return false;
  lexer->mark_end(lexer);
  if (lexer->lookahead == '/') {
    take(lexer);
    read_word(lexer, word);
    if (!is_symbol(lexer, word)) return false;
    scan_unit_rest(lexer);
    lexer->result_symbol = UNIT;
    return true;
  }
  lexer->result_symbol = UNIT_ONE;
  return valid[UNIT_ONE];
}

void *tree_sitter_dosm_external_scanner_create(void) { return NULL; }

void tree_sitter_dosm_external_scanner_destroy(void *payload) { (void)payload; }

unsigned tree_sitter_dosm_external_scanner_serialize(void *payload, char *buffer) {
  (void)payload;
  (void)buffer;
  return 0;
}

void tree_sitter_dosm_external_scanner_deserialize(void *payload, const char *buffer, unsigned length) {
  (void)payload;
  (void)buffer;
  (void)length;
}

bool tree_sitter_dosm_external_scanner_scan(void *payload, TSLexer *lexer, const bool *valid) {
  (void)payload;
  while (is_blank(lexer->lookahead)) lexer->advance(lexer, true);
  if (lexer->lookahead == '/') return valid[BLOCK_COMMENT] && scan_comment(lexer);
  if (is_letter(lexer->lookahead)) return scan_word(lexer, valid);
  if (lexer->lookahead == '1' && valid[UNIT] && !valid[ERROR]) return scan_one(lexer, valid);
  return false;
}
