;;; dosm-mode-test.el --- Tests of dosm-mode  -*- lexical-binding: t; -*-

;;; Commentary:

;; emacs -Q --batch -L .. -l dosm-mode-test.el -f ert-run-tests-batch-and-exit
;;
;; DOSMC names the compiler; DOSM_MISSIONS the missions whose indentation is
;; compared with the formatter's, separated by newlines.

;;; Code:

(require 'cl-lib)
(require 'ert)
(require 'imenu)
(require 'dosm-mode)

(setq dosm-program (or (getenv "DOSMC") "dosmc"))

(defmacro dosm-test--with (text &rest body)
  "Execute BODY in a buffer with TEXT, which is fontified."
  (declare (indent 1))
  `(with-temp-buffer
     (insert ,text)
     (dosm-mode)
     (font-lock-ensure)
     (goto-char (point-min))
     (setq case-fold-search nil
           sentence-end-double-space nil)
     ,@body))

(defun dosm-test--face (needle &optional occurrence)
  "The face of all of NEEDLE, the symbol that is the OCCURRENCE-th (from 1)."
  (goto-char (point-min))
  (if (string-match-p "\\`[A-Za-z0-9_]+\\'" needle)
      (re-search-forward (concat "\\_<" needle "\\_>") nil nil (or occurrence 1))
    (search-forward needle nil nil (or occurrence 1)))
  (let ((faces (mapcar (lambda (at) (get-text-property at 'face))
                       (number-sequence (match-beginning 0) (1- (match-end 0))))))
    (if (cl-every (lambda (face) (equal face (car faces))) faces)
        (car faces)
      (list 'mixed faces))))

(defconst dosm-test--faces
  '(("dosm 1" ("dosm" font-lock-keyword-face) ("1" dosm-number-face))
    ("mission relay" ("relay" font-lock-function-name-face))
    ("param n = 3" ("param" font-lock-keyword-face) ("n" font-lock-variable-name-face) ("3" dosm-number-face))
    ("let speed = 4.5e-1 m/s^2" ("speed" font-lock-variable-name-face) ("4.5e-1" dosm-number-face)
     ("m/s^2" dosm-unit-face))
    ("let a = max(1 min, b2) + pi" ("max" font-lock-builtin-face) ("min" dosm-unit-face) ("b2" nil)
     ("pi" font-lock-constant-face))
    ("let a = min(1, 2)" ("min" font-lock-builtin-face))
    ("let box = radius" ("box" font-lock-variable-name-face) ("radius" nil))
    ("region pi1 = box (9, 1) .. (11.5, 3.5) m or ball (1, 1) radius 2 norm 1"
     ("pi1" font-lock-variable-name-face) ("box" dosm-shape-face) ("11.5" dosm-number-face)
     ("m" dosm-unit-face) ("or" font-lock-keyword-face) ("ball" dosm-shape-face)
     ("radius" font-lock-keyword-face) ("norm" font-lock-keyword-face))
    ("region w = where { x + y <= 2; step >= 1 }" ("where" dosm-shape-face) ("step" nil))
    ("opaque obstacle hill = disc (1, 1) radius 1"
     ("opaque" font-lock-keyword-face) ("obstacle" font-lock-keyword-face)
     ("hill" font-lock-variable-name-face) ("disc" dosm-shape-face))
    ("jammer J[i in 1..3] = ball (4 ± 0.3, i) radius 1"
     ("J" font-lock-variable-name-face) ("in" font-lock-keyword-face) ("3" dosm-number-face) ("0.3" dosm-number-face))
    ("dynamics Rover {\n  step 0.5 s\n  state px: m, step: m/s, load: 1\n  input u: 1/s\n  position px, step\n  A = [1]\n  c = [2]\n  bound step, u in [-1, A]\n  mode wet when { px > 1 } { B = [1] }\n}"
     ("Rover" font-lock-type-face) ("step" font-lock-keyword-face) ("s" dosm-unit-face)
     ("state" font-lock-keyword-face) ("px" nil) ("step" nil 2) ("m/s" dosm-unit-face)
     ("1/s" dosm-unit-face) ("position" font-lock-keyword-face) ("step" nil 3)
     ("A" font-lock-keyword-face) ("c" font-lock-keyword-face) ("A" nil 2) ("bound" font-lock-keyword-face)
     ("step" nil 4) ("mode" font-lock-keyword-face) ("wet" font-lock-type-face)
     ("when" font-lock-keyword-face) ("B" font-lock-keyword-face))
    ("robot fleet[i in 1..n]: Rover at (P[i, 1], 2)\nrobot R2: Boat at { px = 1 }"
     ("fleet" font-lock-variable-name-face) ("Rover" font-lock-type-face) ("at" font-lock-keyword-face)
     ("P" nil) ("R2" font-lock-variable-name-face) ("Boat" font-lock-type-face) ("px" nil))
    ("connectivity { hops <= 3 range 6 m norm 2 every 2 s }"
     ("hops" font-lock-keyword-face) ("range" font-lock-keyword-face) ("norm" font-lock-keyword-face)
     ("every" font-lock-keyword-face) ("s" dosm-unit-face))
    ("connectivity none" ("none" font-lock-constant-face))
    ("minimize effort" ("effort" font-lock-constant-face))
    ("goal g: always eventually[0 s, 4] count(r in all: r in A) >= 2 -> [] p <-> true"
     ("g" font-lock-function-name-face) ("always" dosm-temporal-face) ("eventually" dosm-temporal-face)
     ("s" dosm-unit-face) ("count" dosm-temporal-face) ("in" font-lock-keyword-face)
     ("all" font-lock-constant-face) ("->" font-lock-keyword-face) ("[]" dosm-temporal-face)
     ("<->" font-lock-keyword-face) ("true" font-lock-constant-face) ("p" nil))
    ("define safe = forall r in all: G F X (p U q) && !r"
     ("safe" font-lock-function-name-face) ("forall" dosm-temporal-face) ("G" dosm-temporal-face)
     ("F" dosm-temporal-face) ("X" dosm-temporal-face) ("U" dosm-temporal-face)
     ("&&" font-lock-keyword-face) ("!" font-lock-keyword-face)))
  "Texts, and the faces in them: (NEEDLE FACE OCCURRENCE).")

(ert-deftest dosm-faces ()
  (dolist (case dosm-test--faces)
    (dosm-test--with (car case)
      (pcase-dolist (`(,needle ,face ,occurrence) (cdr case))
        (should (equal (list (car case) needle (dosm-test--face needle occurrence))
                       (list (car case) needle face)))))))

(ert-deftest dosm-comments ()
  (dosm-test--with "//! Top.\n/// Doc.\n//// Plain.\n/* a /* robot */ region */ goal g: a // F b\n"
    (should (eq (dosm-test--face "Top.") 'font-lock-doc-face))
    (should (eq (dosm-test--face "Doc.") 'font-lock-doc-face))
    (should (eq (dosm-test--face "Plain.") 'font-lock-comment-face))
    (should (eq (dosm-test--face "robot") 'font-lock-comment-face))
    (should (eq (dosm-test--face "region") 'font-lock-comment-face))
    (should (eq (dosm-test--face "goal") 'font-lock-keyword-face))
    (should (eq (dosm-test--face "F b") 'font-lock-comment-face))))

(ert-deftest dosm-every-word-has-a-face ()
  "Each word of the language has a face where the mission for the parser has it."
  (with-temp-buffer
    (insert-file-contents (getenv "DOSM_EVERYTHING"))
    (dosm-mode)
    (font-lock-ensure)
    (dolist (word (append dosm--declarations dosm--items dosm--parts dosm--matrices dosm--shapes dosm--temporal
                          dosm--logic dosm--constants dosm--functions '("effort" "::length" "::none")))
      (goto-char (point-min))
      (let ((case-fold-search nil) faces)
        (while (re-search-forward (concat "\\_<" word "\\_>") nil t)
          (unless (nth 4 (save-excursion (syntax-ppss (match-beginning 0))))
            (push (get-text-property (match-beginning 0) 'face) faces)))
        (should (or (string-prefix-p "::" word) (list word faces)))
        (unless (string-prefix-p "::" word)
          (should (equal (list word (and (remq nil faces) t)) (list word t))))))))

(defun dosm-test--formatted (file)
  "What the formatter makes of FILE."
  (with-temp-buffer
    (let ((status (call-process dosm-program file (list t nil) nil "fmt" "-")))
      (should (memq status '(0 1)))
      (buffer-string))))

(ert-deftest dosm-indentation-is-the-formatters ()
  (let ((files (split-string (getenv "DOSM_MISSIONS") "\n" t)))
    (should (> (length files) 40))
    (dolist (file files)
      (let ((formatted (dosm-test--formatted file)))
        (dosm-test--with formatted
          (while (not (eobp))
            (unless (nth 4 (syntax-ppss)) (delete-horizontal-space))
            (forward-line 1))
          (let ((inhibit-message t)) (indent-region (point-min) (point-max)))
          (should (equal (list file (buffer-string)) (list file formatted))))))))

(ert-deftest dosm-indentation-while-typing ()
  (dosm-test--with ""
    (electric-indent-local-mode 1)
    (dolist (line '("dynamics R {" "step 0.5 s" "state px: m," "vx: m/s" "A = [1, 0;" "0, 1]" "}" "goal g: a" "and b"))
      (mapc (lambda (char) (let ((last-command-event char)) (call-interactively #'self-insert-command))) line)
      (let ((last-command-event ?\n)) (call-interactively #'newline))
      (indent-according-to-mode))
    (should (equal (replace-regexp-in-string "[ \t]+$" "" (buffer-string))
                   "dynamics R {\n  step 0.5 s\n  state px: m,\n    vx: m/s\n  A = [1, 0;\n       0, 1]\n}\ngoal g: a\n  and b\n"))))

(ert-deftest dosm-documentation-goes-on ()
  (dosm-test--with "/// One."
    (goto-char (point-max))
    (default-indent-new-line)
    (insert "Two.")
    (should (equal (buffer-string) "/// One.\n/// Two."))))

(ert-deftest dosm-comments-are-put-and-taken ()
  (dosm-test--with "region a = box (0, 0) .. (1, 1)\nbase b at (1, 1)\n"
    (let ((text (buffer-string)))
      (comment-region (point-min) (point-max))
      (should (equal (buffer-string) "// region a = box (0, 0) .. (1, 1)\n// base b at (1, 1)\n"))
      (uncomment-region (point-min) (point-max))
      (should (equal (buffer-string) text)))))

(ert-deftest dosm-paragraphs-are-filled ()
  (dosm-test--with "/// A long line about nothing that has to be filled because it is too long for it.\n/// Next.\nregion a = box (0, 0) .. (1, 1)\n"
    (setq fill-column 50)
    (fill-paragraph)
    (should (equal (buffer-string)
                   "/// A long line about nothing that has to be\n/// filled because it is too long for it. Next.\nregion a = box (0, 0) .. (1, 1)\n"))))

(ert-deftest dosm-menu ()
  (dosm-test--with "param n = 1\nregion A = box (0, 0) .. (1, 1)\n// region B = box\nopaque obstacle O = box\njammer J = ball\nbase B1 at (1, 1)\ndynamics D {\n}\nrobot f[i in 1..2]: D at (1, 1)\nteam t = f\ndefine d = true\ngoal g: d\n"
    (let* ((index (save-excursion (imenu--make-index-alist t)))
           (names (mapcar (lambda (group) (cons (car group) (mapcar #'car (cdr group))))
                          (seq-filter (lambda (group) (listp (cdr group))) index))))
      (should (equal (cdr (assoc "Goals" names)) '("g")))
      (should (equal (cdr (assoc "Definitions" names)) '("d")))
      (should (equal (cdr (assoc "Robots" names)) '("f" "t")))
      (should (equal (cdr (assoc "Dynamics" names)) '("D")))
      (should (equal (cdr (assoc "Regions" names)) '("A")))
      (should (equal (cdr (assoc "Blockers" names)) '("O" "J")))
      (should (equal (cdr (assoc "Bases" names)) '("B1")))
      (should (equal (cdr (assoc "Constants" names)) '("n"))))))

(ert-deftest dosm-moves-over-declarations ()
  (dosm-test--with "region a = box (0, 0) .. (1, 1)\n\ndynamics D {\n  step 1 s\n}\n\ngoal g: true\n"
    (search-forward "step")
    (beginning-of-defun)
    (should (looking-at "dynamics"))
    (end-of-defun)
    (should (equal (buffer-substring (point-min) (point))
                   "region a = box (0, 0) .. (1, 1)\n\ndynamics D {\n  step 1 s\n}\n"))
    (beginning-of-defun 2)
    (should (looking-at "region"))))

(ert-deftest dosm-completion-without-a-server ()
  (dosm-test--with "region depot = box (0, 0) .. (1, 1)\ngoal g: alw dep"
    (let ((all (lambda () (pcase-let ((`(,begin ,end ,table . ,_) (dosm-completion-at-point)))
                            (all-completions (buffer-substring begin end) table)))))
      (search-forward "alw")
      (should (equal (funcall all) '("always")))
      (search-forward "dep")
      (should (equal (funcall all) '("depot"))))))

(ert-deftest dosm-formats-with-the-compiler ()
  (dosm-test--with "dosm 1\nregion a=box(0,0)..( 1,1 )\nregion b = \n"
    (search-forward "region b")
    (dosm-format-buffer)
    (should (looking-back "region b" (line-beginning-position)))
    (should (string-prefix-p "dosm 1\nregion a = box (0, 0) .. (1, 1)\n" (buffer-string))))
  (dosm-test--with "dosm 1\n"
    (let ((dosm-program "/nowhere/dosmc"))
      (should-error (dosm-format-buffer)))))

(ert-deftest dosm-places-of-the-compilers-errors-are-known ()
  (let ((file (make-temp-file "dosm" nil ".dosm" "dosm 1\nregion a = bix (0, 0) .. (1, 1)\n")))
    (unwind-protect
        (with-temp-buffer
          (call-process dosm-program nil t nil "check" file)
          (goto-char (point-min))
          (should (re-search-forward dosm--error-regexp nil t))
          (should (equal (expand-file-name (match-string 1)) file))
          (should (equal (match-string 2) "2")))
      (delete-file file))))

(ert-deftest dosm-files-are-missions ()
  (let ((file (make-temp-file "dosm" nil ".dosm" "dosm 1\n")))
    (unwind-protect
        (with-current-buffer (find-file-noselect file)
          (should (derived-mode-p 'dosm-mode))
          (should (string-match-p "check .*\\.dosm" compile-command))
          (kill-buffer))
      (delete-file file))))

(provide 'dosm-mode-test)
;;; dosm-mode-test.el ends here
