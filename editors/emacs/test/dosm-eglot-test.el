;;; dosm-eglot-test.el --- A session of Eglot with the language server  -*- lexical-binding: t; -*-

;;; Commentary:

;; emacs -Q --batch -L .. -l dosm-eglot-test.el -f ert-run-tests-batch-and-exit
;;
;; DOSMC names the compiler; DOSM_MISSION is a mission with a plan that is found
;; at once.  Before Emacs 29, Eglot has to be in the load path.

;;; Code:

(require 'cl-lib)
(require 'ert)
(require 'dosm-mode)
(require 'eglot)
(require 'flymake)

(setq dosm-program (or (getenv "DOSMC") "dosmc"))

(defun dosm-test--wait (what condition)
  "Wait until CONDITION, a function, holds; WHAT says what is waited for."
  (let ((end (+ (float-time) 30)) value)
    (while (and (not (setq value (funcall condition))) (< (float-time) end))
      (accept-process-output nil 0.05))
    (unless value (ert-fail (format "%s did not come" what)))
    value))

(defmacro dosm-test--session (text &rest body)
  "Execute BODY in a buffer of a file with TEXT that Eglot manages."
  (declare (indent 1))
  `(let* ((directory (make-temp-file "dosm" t))
          (file (expand-file-name "mission.dosm" directory))
          (eglot-autoshutdown t)
          (eglot-sync-connect 30))
     (with-temp-file file (insert ,text))
     (unwind-protect
         (with-current-buffer (find-file-noselect file)
           (unwind-protect
               (progn
                 (apply #'eglot (eglot--guess-contact))
                 (should (eglot-managed-p))
                 ,@body)
             (set-buffer-modified-p nil)
             (when (eglot-current-server) (eglot-shutdown (eglot-current-server)))
             (kill-buffer)))
       (delete-directory directory t))))

(defun dosm-test--mission ()
  "The text of a mission with a plan."
  (with-temp-buffer
    (insert-file-contents (getenv "DOSM_MISSION"))
    (buffer-string)))

(defun dosm-test--complaints ()
  "The texts of the buffer's diagnostics."
  (mapcar #'flymake-diagnostic-text (flymake-diagnostics)))

(ert-deftest dosm-eglot-diagnostics-and-rename ()
  (dosm-test--session (concat (dosm-test--mission) "\ngoal ghost: eventually nobody in nowhere\n")
    (flymake-start)
    (let ((said (dosm-test--wait "a diagnostic" #'dosm-test--complaints)))
      (should (cl-some (lambda (text) (string-match-p "nobody" text)) said)))
    ;; What isn't saved is checked, too.
    (goto-char (point-max))
    (search-backward "goal ghost")
    (delete-region (point) (point-max))
    (eglot--signal-textDocument/didChange)
    (dosm-test--wait "silence" (lambda () (null (dosm-test--complaints))))
    ;; A robot is renamed everywhere.
    (goto-char (point-min))
    (re-search-forward "^robot \\([A-Za-z0-9_]+\\)")
    (let ((old (match-string 1)))
      (goto-char (match-beginning 1))
      (eglot-rename "renamed_robot")
      (goto-char (point-min))
      (should-not (re-search-forward (concat "\\_<" old "\\_>[ \t]+in\\_>") nil t))
      (should (re-search-forward "renamed_robot in" nil t)))))

(ert-deftest dosm-eglot-hover-and-completion ()
  (dosm-test--session (dosm-test--mission)
    (re-search-forward "^region [A-Za-z0-9_]")
    (backward-char)
    (let ((hover (jsonrpc-request (eglot-current-server) :textDocument/hover
                                  (eglot--TextDocumentPositionParams))))
      (should (string-match-p "region" (format "%s" hover))))
    (goto-char (point-max))
    (insert "goal more: eventually ")
    (eglot--signal-textDocument/didChange)
    (pcase-let ((`(,begin ,end ,table . ,_) (eglot-completion-at-point)))
      (should (member "true" (mapcar #'string-trim (all-completions (buffer-substring begin end) table)))))))

(ert-deftest dosm-eglot-formats ()
  (dosm-test--session "dosm 1\nregion   a=box(0,0)..( 1,1 )\n"
    (eglot-format-buffer)
    (should (equal (buffer-string) "dosm 1\nregion a = box (0, 0) .. (1, 1)\n"))))

(ert-deftest dosm-eglot-plans ()
  (dosm-test--session (dosm-test--mission)
    (let (shown)
      (cl-letf (((symbol-function 'browse-url-of-file) (lambda (file) (push file shown)))
                ((symbol-function 'browse-url) (lambda (url &rest _) (push (url-filename (url-generic-parse-url url)) shown))))
        (dosm-solve)
        (dosm-test--wait "a picture" (lambda () shown))
        (should-not dosm--request)
        (should (string-suffix-p ".svg" (car shown)))
        (should (file-exists-p (car shown)))
        (setq shown nil)
        (dosm-open-page)
        (dosm-test--wait "the page" (lambda () shown))
        (should (string-suffix-p ".html" (car shown)))))))

(ert-deftest dosm-eglot-says-why-it-can-not-plan ()
  (dosm-test--session "dosm 1\n"
    (let (said)
      (cl-letf (((symbol-function 'message) (lambda (form &rest rest) (push (apply #'format (or form "") rest) said))))
        (dosm-open-picture)
        (dosm-test--wait "a refusal" (lambda () (cl-some (lambda (text) (string-match-p "no plan" text)) said)))))))

(provide 'dosm-eglot-test)
;;; dosm-eglot-test.el ends here
