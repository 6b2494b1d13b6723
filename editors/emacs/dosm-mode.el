;;; dosm-mode.el --- Major mode for dosm missions  -*- lexical-binding: t; -*-

;; Copyright (C) 2026 The dosmc authors

;; Author: The dosmc authors
;; Version: 0.1.0
;; Package-Requires: ((emacs "27.1"))
;; Keywords: languages, tools
;; SPDX-License-Identifier: MIT OR Apache-2.0

;; This file is not part of GNU Emacs.

;;; Commentary:

;; Editing of missions for dosmc, the planner for robots in temporal logic:
;; highlighting, indentation, a menu of declarations, completion of words, and
;; the formatter.  With Eglot or lsp-mode the language server `dosmc lsp' adds
;; diagnostics, hovers, completion that knows its place, renaming and more, and
;; `dosm-solve' plans the mission in the background.
;;
;; (require 'dosm-mode) is all that is needed.  To start the server with every
;; mission: (add-hook 'dosm-mode-hook #'eglot-ensure).
;;
;; The lists of words below are written by the compiler's tests
;; (DOSMC_UPDATE=1 cargo test --test editors).

;;; Code:

(require 'compile)
(require 'easymenu)
(require 'thingatpt)
(require 'url-util)

(defvar eglot-server-programs)
(defvar imenu-case-fold-search)
(defvar lsp-language-id-configuration)
(declare-function eglot-current-server "ext:eglot")
(declare-function jsonrpc-async-request "ext:jsonrpc")
(declare-function jsonrpc-notify "ext:jsonrpc")
(declare-function lsp-register-client "ext:lsp-mode")
(declare-function lsp-request-async "ext:lsp-mode")
(declare-function lsp-stdio-connection "ext:lsp-mode")
(declare-function lsp-workspaces "ext:lsp-mode")
(declare-function make-lsp-client "ext:lsp-mode")

(defgroup dosm nil
  "Missions for robots in temporal logic."
  :group 'languages
  :prefix "dosm-")

(defcustom dosm-program "dosmc"
  "The compiler: a name that is looked for in variable `exec-path', or a path."
  :type 'string)

(defcustom dosm-indent-offset 2
  "How far what is inside braces, and what goes on, is indented.
The formatter uses 2."
  :type 'integer
  :safe #'integerp)

(defcustom dosm-format-on-save nil
  "Whether missions are formatted before they are saved."
  :type 'boolean
  :safe #'booleanp)

(defface dosm-temporal-face '((t :inherit font-lock-builtin-face))
  "Face of temporal operators and quantifiers.")

(defface dosm-shape-face '((t :inherit font-lock-type-face))
  "Face of shapes.")

(defface dosm-number-face '((t :inherit font-lock-constant-face))
  "Face of numbers.")

(defface dosm-unit-face '((t :inherit font-lock-type-face))
  "Face of units.")

;;;; Words

(defconst dosm--declarations
  ;; words(declarations)
  '("dosm" "mission" "param" "let" "workspace" "region" "obstacle" "opaque" "jammer" "base"
    "dynamics" "robot" "team" "separation" "connectivity" "horizon" "minimize" "goal" "define")
  "The words that begin declarations.")

(defconst dosm--items
  ;; words(dynamics_items, connectivity_items)
  '("step" "state" "input" "position" "continuous" "integrator" "bound" "disturbance" "rejection"
    "mode" "hops" "range" "redundancy" "every")
  "The words that begin items of blocks.")

(defconst dosm--parts
  ;; words(dynamics_parts, shape_parts)
  '("when" "radius" "norm")
  "The words inside items and shapes.")

(defconst dosm--matrices
  ;; words(matrices)
  '("A" "B" "c")
  "The matrices of a model.")

(defconst dosm--shapes
  ;; words(shapes)
  '("box" "ball" "disc" "polygon" "hull" "where")
  "The words that begin shapes.")

(defconst dosm--temporal
  ;; words(temporal, temporal_letters, quantifiers)
  '("always" "eventually" "next" "until" "release" "weak" "strong" "X" "F" "G" "U" "R" "W" "M"
    "forall" "exists" "count")
  "The temporal operators and quantifiers that are words.")

(defconst dosm--logic
  ;; words(logic, prepositions)
  '("and" "or" "not" "in" "at")
  "The other operators that are words.")

(defconst dosm--constants
  ;; words(truths, sets, constants)
  '("true" "false" "all" "pi")
  "The constants that are the same everywhere.")

(defconst dosm--placed-constants
  ;; words(objectives, connectivity_off)
  '("effort" "length" "none")
  "What may stand behind `minimize' and `connectivity'.")

(defconst dosm--functions
  ;; words(functions)
  '("sqrt" "sin" "cos" "min" "max" "abs" "floor" "mod")
  "The functions.")

(defconst dosm--coordinates
  ;; words(coordinates)
  '("x" "y" "z")
  "The coordinates inside `where'.")

(defconst dosm--units
  ;; words(units)
  '("m" "cm" "mm" "km" "s" "ms" "min" "rad" "deg" "kg" "g" "N")
  "The symbols of units.")

(defconst dosm--temporal-signs
  ;; words(temporal_signs)
  '("[]" "<>")
  "The temporal operators that are signs.")

(defconst dosm--logic-signs
  ;; words(logic_signs)
  '("<->" "->" "||" "&&" "!")
  "The operators of propositional logic that are signs.")

(defconst dosm--name "[A-Za-z_][A-Za-z0-9_]*"
  "A name.")

(defconst dosm--declaration-regexp (regexp-opt dosm--declarations 'symbols)
  "A word that begins a declaration.")

(defconst dosm--item-regexp
  (concat (regexp-opt dosm--items 'symbols)
          "\\|" (regexp-opt dosm--matrices 'symbols) "[ \t]*=")
  "What begins an item of a block.")

;;;; Syntax

(defvar dosm-mode-syntax-table
  (let ((table (make-syntax-table)))
    ;; `//' to the end of the line, and `/* */', which nests.
    (modify-syntax-entry ?/ ". 124b" table)
    (modify-syntax-entry ?* ". 23n" table)
    (modify-syntax-entry ?\n "> b" table)
    (modify-syntax-entry ?_ "_" table)
    (modify-syntax-entry ?\" "." table)
    (modify-syntax-entry ?\' "." table)
    (modify-syntax-entry ?\\ "." table)
    (modify-syntax-entry ?$ "." table)
    (modify-syntax-entry ?% "." table)
    (dolist (sign '(?+ ?- ?= ?< ?> ?& ?| ?! ?^ ?. ?±))
      (modify-syntax-entry sign "." table))
    table)
  "Syntax table of `dosm-mode'.")

(defun dosm--syntactic-face (state)
  "The face of the comment that STATE is in."
  (save-excursion
    (goto-char (nth 8 state))
    (if (looking-at "//!\\|///\\(?:[^/]\\|$\\)")
        'font-lock-doc-face
      'font-lock-comment-face)))

(defun dosm--block-head (state)
  "The word before the innermost bracket of STATE if that is a brace."
  (let ((open (nth 1 state)))
    (when (and open (eq (char-after open) ?{))
      (save-excursion
        (goto-char open)
        (skip-chars-backward " \t\n")
        (if (looking-back (concat "\\_<" dosm--name) (line-beginning-position) t)
            (match-string-no-properties 0)
          "")))))

(defun dosm--item-at-p (begin end)
  "Whether the word from BEGIN to END is an item's and no name."
  (save-match-data
    (save-excursion
      (let ((head (dosm--block-head (syntax-ppss begin))))
        (and head
             (not (member head '("where" "when" "at")))
             (not (progn (goto-char end) (looking-at-p "[ \t]*[:,)]\\|[ \t]+in\\_>")))
             (not (progn (goto-char begin)
                         (skip-chars-backward " \t")
                         (memq (char-before) '(?, ?+ ?- ?* ?/ ?\( ?=)))))))))

(defun dosm--match-item (limit)
  "Search for an item of a block before LIMIT."
  (let (found)
    (while (and (not found) (re-search-forward (regexp-opt dosm--items 'symbols) limit t))
      (setq found (dosm--item-at-p (match-beginning 0) (match-end 0))))
    found))

(defun dosm--match-matrix (limit)
  "Search for a matrix of a model before LIMIT."
  (let (found)
    (while (and (not found)
                (re-search-forward (concat (regexp-opt dosm--matrices 'symbols) "[ \t]*=") limit t))
      (setq found (save-match-data
                    (save-excursion (dosm--block-head (syntax-ppss (match-beginning 0)))))))
    found))

(defconst dosm--unit-regexp
  (let* ((symbol (concat (regexp-opt dosm--units) "\\_>"))
         (factor (concat symbol "\\(?:\\^-?[0-9]+\\)?")))
    (concat "\\(?:1/\\)?" factor "\\(?:[*/]" factor "\\)*"))
  "A unit.")

(defvar dosm-font-lock-keywords
  (let ((name (concat "\\(" dosm--name "\\)")))
    `((,(concat "\\_<\\(dynamics\\)\\_>[ \t\n]+" name) 2 font-lock-type-face)
      (,(concat "\\_<\\(mission\\|goal\\|define\\)\\_>[ \t\n]+" name) 2 font-lock-function-name-face)
      (,(concat "\\_<\\(param\\|let\\|region\\|obstacle\\|jammer\\|base\\|robot\\|team\\)\\_>[ \t\n]+" name)
       2 font-lock-variable-name-face)
      (,(concat "\\_<robot\\_>[^:={}]*:[ \t\n]*" name) 1 font-lock-type-face)
      (,(concat "\\_<\\(mode\\)[ \t]+" name "[ \t]+\\_<when\\_>") 2 font-lock-type-face)
      (,(concat "\\_<\\(count\\)\\_>[ \t]*(\\|" (regexp-opt '("forall" "exists") 'symbols))
       0 'dosm-temporal-face nil t)
      (,dosm--declaration-regexp . font-lock-keyword-face)
      (,(regexp-opt dosm--temporal 'symbols) . 'dosm-temporal-face)
      (,(regexp-opt dosm--logic 'symbols) . font-lock-keyword-face)
      (,(regexp-opt dosm--constants 'symbols) . font-lock-constant-face)
      (,(concat "\\_<\\(?:minimize\\|connectivity\\)[ \t]+" (regexp-opt dosm--placed-constants 'symbols))
       1 font-lock-constant-face)
      (,(concat (regexp-opt dosm--functions 'symbols) "[ \t]*(") 1 font-lock-builtin-face)
      (,(concat "\\(?:=\\|\\_<or\\|\\_<workspace\\)[ \t\n]*" (regexp-opt dosm--shapes 'symbols))
       1 'dosm-shape-face)
      ("\\_<\\(where\\)\\_>[ \t]*{" 1 'dosm-shape-face)
      ("\\_<\\(when\\)\\_>[ \t]*{" 1 font-lock-keyword-face)
      (,(concat (regexp-opt dosm--parts 'symbols) "[ \t]+[-(0-9A-Za-z_]") 1 font-lock-keyword-face)
      (dosm--match-item . font-lock-keyword-face)
      (dosm--match-matrix 1 font-lock-keyword-face)
      (,(concat "[])0-9][ \t]*\\_<\\(" dosm--unit-regexp "\\)") 1 'dosm-unit-face)
      (,(concat ":[ \t]*\\_<\\(" dosm--unit-regexp "\\|1\\_>\\)") 1 'dosm-unit-face)
      ("\\_<[0-9]+\\(?:\\.[0-9]+\\)?\\(?:[eE][-+]?[0-9]+\\)?" . 'dosm-number-face)
      (,(regexp-opt dosm--temporal-signs) . 'dosm-temporal-face)
      (,(regexp-opt dosm--logic-signs) . font-lock-keyword-face)))
  "Highlighting of `dosm-mode'.")

;;;; Indentation

(defun dosm--begins-declaration-p ()
  "Whether a declaration begins at point."
  (looking-at-p dosm--declaration-regexp))

(defun dosm--begins-item-p ()
  "Whether an item of a block begins at point."
  (and (looking-at dosm--item-regexp)
       (let ((head (dosm--block-head (syntax-ppss))))
         (not (member head '("where" "when" "at"))))))

(defun dosm--after-end-p ()
  "Whether what stands before point ends something: a brace or a semicolon."
  (save-excursion
    (forward-comment (- (point)))
    (memq (char-before) '(?{ ?\; ?} nil))))

(defun dosm--bracket-column (open)
  "The column of what is inside the bracket at OPEN."
  (save-excursion
    (goto-char (1+ open))
    (skip-chars-forward " \t")
    (if (looking-at-p "$\\|//\\|/\\*")
        (progn (goto-char open) (+ (current-indentation) dosm-indent-offset))
      (current-column))))

(defun dosm--block-column (open)
  "The column of the items of the block whose brace is at OPEN."
  (save-excursion
    (goto-char open)
    (+ dosm-indent-offset (dosm--line-column-of-block))))

(defun dosm--line-column-of-block ()
  "The indentation of the item or declaration whose brace is at point."
  (let ((outer (nth 1 (syntax-ppss))))
    (if (and outer (eq (char-after outer) ?{)) (dosm--block-column outer) 0)))

(defun dosm--code-column ()
  "The column for the code at point, which is the first of its line."
  (let ((open (nth 1 (syntax-ppss))))
    (cond
     ((dosm--begins-declaration-p) 0)
     ((null open)
      (if (or (eobp) (bobp) (dosm--nothing-before-p)) 0 dosm-indent-offset))
     ((not (eq (char-after open) ?{))
      (if (looking-at-p "[])]") (save-excursion (goto-char open) (current-indentation))
        (dosm--bracket-column open)))
     ((eq (char-after) ?}) (- (dosm--block-column open) dosm-indent-offset))
     ((or (dosm--begins-item-p) (dosm--after-end-p)) (dosm--block-column open))
     (t (+ (dosm--block-column open) dosm-indent-offset)))))

(defun dosm--nothing-before-p ()
  "Whether there is only white space and comments before point."
  (save-excursion
    (forward-comment (- (point)))
    (bobp)))

(defun dosm--column ()
  "The column for the line that point is at the first character of.
Nil where the line is inside a comment, which stays as it is."
  (let ((state (syntax-ppss)))
    (cond
     ((nth 4 state) nil)
     ;; A comment is where what follows is.
     ((looking-at-p "//\\|/\\*\\|$")
      (let ((open (nth 1 state)))
        (save-excursion
          (forward-comment (buffer-size))
          (cond
           ((or (eobp) (and open (not (eq open (nth 1 (syntax-ppss))))) (memq (char-after) '(?} ?\] ?\))))
            (if open (if (eq (char-after open) ?{) (dosm--block-column open) (dosm--bracket-column open)) 0))
           (t (dosm--code-column))))))
     (t (dosm--code-column)))))

(defun dosm-indent-line ()
  "Indent the line as the formatter would."
  (interactive)
  (let* ((case-fold-search nil)
         (column (save-excursion (back-to-indentation) (dosm--column)))
         (from-end (- (point-max) (point))))
    (if (null column)
        'noindent
      (save-excursion (indent-line-to column))
      (if (<= (current-column) column)
          (back-to-indentation)
        (goto-char (- (point-max) from-end))))))

;;;; Names

(defvar dosm-imenu-generic-expression
  (let ((entry (lambda (title words)
                 (list title
                       (concat "^[ \t]*\\_<\\(?:" words "\\)\\_>[ \t\n]+\\(" dosm--name "\\)") 1))))
    (list (funcall entry "Goals" "goal")
          (funcall entry "Definitions" "define")
          (funcall entry "Robots" "robot\\|team")
          (funcall entry "Dynamics" "dynamics")
          (funcall entry "Regions" "region")
          (funcall entry "Blockers" "jammer\\|\\(?:opaque[ \t\n]+\\)?obstacle")
          (funcall entry "Bases" "base")
          (funcall entry "Constants" "param\\|let")))
  "The menu of declarations of `dosm-mode'.")

(defun dosm--declared-names ()
  "The names that the buffer declares."
  (let (names)
    (save-excursion
      (goto-char (point-min))
      (while (re-search-forward
              (concat "^[ \t]*\\_<\\(?:param\\|let\\|region\\|obstacle\\|opaque[ \t]+obstacle\\|jammer\\|base"
                      "\\|dynamics\\|robot\\|team\\|goal\\|define\\)\\_>[ \t]+\\(" dosm--name "\\)")
              nil t)
        (push (match-string-no-properties 1) names)))
    names))

(defun dosm-completion-at-point ()
  "Complete the words of the language and the names of the mission.
The language server knows what fits; this is for when there is none."
  (let ((bounds (bounds-of-thing-at-point 'symbol)))
    (when (and bounds (not (nth 4 (syntax-ppss))))
      (list (car bounds) (cdr bounds)
            (completion-table-dynamic
             (lambda (_)
               (append (dosm--declared-names) dosm--declarations dosm--items dosm--parts dosm--shapes
                       dosm--temporal dosm--logic dosm--constants dosm--placed-constants dosm--functions)))
            :exclusive 'no))))

(defun dosm-beginning-of-defun (&optional arg)
  "Move to the beginning of the declaration, ARG times."
  (let ((case-fold-search nil))
    (re-search-backward (concat "^" dosm--declaration-regexp) nil 'move (or arg 1))))

(defun dosm-end-of-defun ()
  "Move to the end of the declaration that begins at point."
  (forward-char)
  (let ((case-fold-search nil))
    (if (re-search-forward (concat "^" dosm--declaration-regexp) nil 'move)
        (goto-char (match-beginning 0))))
  (forward-comment (- (point)))
  (forward-line 1))

;;;; The compiler

(defun dosm-format-buffer ()
  "Format the mission; what can't be read stays as it is."
  (interactive)
  (let ((output (generate-new-buffer " *dosm-format*" t))
        (errors (make-temp-file "dosm-format")))
    (unwind-protect
        (let ((status (call-process-region nil nil dosm-program nil (list output errors) nil "fmt" "-")))
          (if (and (memq status '(0 1)) (> (buffer-size output) 0))
              (replace-buffer-contents output)
            (user-error "%s" (dosm--first-line errors))))
      (kill-buffer output)
      (delete-file errors))))

(defun dosm--first-line (file)
  "The first line of FILE with something in it."
  (with-temp-buffer
    (insert-file-contents file)
    (if (re-search-forward "[^ \t\n].*" nil t) (match-string 0) "It could not be formatted")))

(defun dosm--before-save ()
  "Format the mission if variable `dosm-format-on-save' is non-nil."
  (when dosm-format-on-save (ignore-errors (dosm-format-buffer))))

(defconst dosm--error-regexp "[╭,][─-]\\[\\([^]\n]+\\):\\([0-9]+\\):\\([0-9]+\\)\\]"
  "The place of a diagnostic, as `dosmc check' prints it.")

(add-to-list 'compilation-error-regexp-alist-alist `(dosm ,dosm--error-regexp 1 2 3))
(add-to-list 'compilation-error-regexp-alist 'dosm)

;;;; The language server

(with-eval-after-load 'eglot
  (add-to-list 'eglot-server-programs
               `(dosm-mode . ,(lambda (&rest _) (list dosm-program "lsp")))))

(with-eval-after-load 'lsp-mode
  (add-to-list 'lsp-language-id-configuration '(dosm-mode . "dosm"))
  (lsp-register-client
   (make-lsp-client :new-connection (lsp-stdio-connection (lambda () (list dosm-program "lsp")))
                    :major-modes '(dosm-mode)
                    :server-id 'dosmc)))

(defun dosm--uri ()
  "The URI of the file of the buffer."
  (concat "file://" (url-hexify-string (expand-file-name (or buffer-file-name (user-error "Save the mission first")))
                                       url-path-allowed-chars)))

(defun dosm--shows-documents-p (server)
  "Whether SERVER, one of Eglot, was told that Emacs can show documents."
  (when (fboundp 'eglot-client-capabilities)
    (plist-get (plist-get (eglot-client-capabilities server) :window) :showDocument)))

(defvar-local dosm--request nil
  "The number of the request to plan that is under way.")

(defun dosm--execute (command done)
  "Ask the language server to execute COMMAND for the mission.
DONE is called with its answer, and whether Emacs has to open what there is."
  (let* ((server (and (featurep 'eglot) (eglot-current-server)))
         (buffer (current-buffer))
         (parameters (list :command command :arguments (vector (dosm--uri))))
         (failed (lambda (&rest failure)
                   (with-current-buffer buffer (setq dosm--request nil))
                   (message "dosmc: %s" (or (plist-get (car failure) :message) (car failure))))))
    (cond
     (server
      (setq dosm--request
            (car (jsonrpc-async-request
                  server :workspace/executeCommand parameters
                  :timeout nil :error-fn failed
                  :success-fn (lambda (answer)
                                (with-current-buffer buffer (setq dosm--request nil))
                                (funcall done answer (not (dosm--shows-documents-p server))))))))
     ((and (featurep 'lsp-mode) (lsp-workspaces))
      (lsp-request-async "workspace/executeCommand" parameters
                         (lambda (answer) (funcall done answer nil))
                         :error-handler failed :mode 'detached))
     (t (user-error "No language server: M-x eglot starts it")))))

(defun dosm--get (answer key)
  "The value of KEY, a keyword, in ANSWER, a property list or a hash table."
  (if (hash-table-p answer)
      (gethash (substring (symbol-name key) 1) answer)
    (plist-get answer key)))

(defun dosm-solve ()
  "Plan the mission in the background.
Show the plan's picture in the end, or say why there is no plan."
  (interactive)
  (message "dosmc: planning…")
  (dosm--execute "dosmc.solve"
                 (lambda (answer open)
                   (let ((picture (dosm--get answer :picture)))
                     (message "dosmc: %s" (dosm--get answer :message))
                     (when (and open picture) (browse-url-of-file picture))))))

(defun dosm-cancel ()
  "Stop planning the mission."
  (interactive)
  (let ((server (and (featurep 'eglot) (eglot-current-server))))
    (unless (and server dosm--request) (user-error "Nothing is planned"))
    (jsonrpc-notify server :$/cancelRequest (list :id dosm--request))))

(defun dosm-open-picture ()
  "Open the picture of the mission's last plan."
  (interactive)
  (dosm--execute "dosmc.openPicture" (lambda (file open) (when open (browse-url-of-file file)))))

(defun dosm-open-page ()
  "Open the page on which the robots of the mission's last plan move."
  (interactive)
  (dosm--execute "dosmc.openPage" (lambda (file open) (when open (browse-url-of-file file)))))

;;;; The mode

(defvar dosm-mode-map
  (let ((map (make-sparse-keymap)))
    (define-key map (kbd "C-c C-c") #'dosm-solve)
    (define-key map (kbd "C-c C-k") #'dosm-cancel)
    (define-key map (kbd "C-c C-p") #'dosm-open-picture)
    (define-key map (kbd "C-c C-a") #'dosm-open-page)
    (define-key map (kbd "C-c C-f") #'dosm-format-buffer)
    map)
  "Keys of `dosm-mode'.")

(easy-menu-define dosm-mode-menu dosm-mode-map "Menu of `dosm-mode'."
  '("Mission"
    ["Plan" dosm-solve]
    ["Stop planning" dosm-cancel]
    ["Open picture" dosm-open-picture]
    ["Open animation" dosm-open-page]
    "--"
    ["Format" dosm-format-buffer]
    ["Check" compile]))

;;;###autoload
(define-derived-mode dosm-mode prog-mode "Mission"
  "Major mode for dosm missions.

\\{dosm-mode-map}"
  (setq-local font-lock-defaults
              '(dosm-font-lock-keywords nil nil nil
                                        (font-lock-syntactic-face-function . dosm--syntactic-face)))
  (setq-local font-lock-multiline t)
  (setq-local comment-start "// ")
  (setq-local comment-end "")
  (setq-local comment-start-skip "\\(?://[/!]*\\|/\\*+\\)[ \t]*")
  (setq-local comment-multi-line t)
  (setq-local parse-sexp-ignore-comments t)
  (setq-local indent-line-function #'dosm-indent-line)
  (setq-local indent-tabs-mode nil)
  (setq-local tab-width dosm-indent-offset)
  (setq-local electric-indent-chars (append '(?} ?\] ?\)) electric-indent-chars))
  (setq-local imenu-generic-expression dosm-imenu-generic-expression)
  (setq-local imenu-case-fold-search nil)
  (setq-local beginning-of-defun-function #'dosm-beginning-of-defun)
  (setq-local end-of-defun-function #'dosm-end-of-defun)
  (setq-local outline-regexp dosm--declaration-regexp)
  (when buffer-file-name
    (setq-local compile-command (concat dosm-program " check " (shell-quote-argument buffer-file-name))))
  (add-hook 'completion-at-point-functions #'dosm-completion-at-point nil t)
  (add-hook 'before-save-hook #'dosm--before-save nil t))

;;;###autoload
(add-to-list 'auto-mode-alist '("\\.dosm\\'" . dosm-mode))

(provide 'dosm-mode)
;;; dosm-mode.el ends here
