;;; check.el --- The set-up lines of docs/editors.md, tried  -*- lexical-binding: t -*-

;; Run in batch mode behind those lines, on editors/bracket.nc: what a user does by keys, done
;; by the functions behind them.  Writes "ok" or "no", a name and what was seen.

(require 'eglot)
(require 'flymake)
(setq eglot-confirm-server-initiated-edits nil eglot-confirm-server-edits nil)

(defvar check-results nil)
(setq print-escape-newlines t)

(defun check (name is-right seen)
  (push (format "%s %s: %S\n" (if is-right "ok" "no") name seen) check-results))

(defun check-until (name ask wanted)
  "Waits until what ASK gives is as WANTED, and writes it down under NAME."
  (let ((tries 0))
    (while (and (< tries 400) (not (funcall wanted (funcall ask))))
      (setq tries (1+ tries))
      (accept-process-output nil 0.05)
      (run-hooks 'post-command-hook)
      (when (bound-and-true-p eglot--managed-mode) (ignore-errors (eglot--signal-textDocument/didChange))))
    (let ((seen (funcall ask)))
      (check name (funcall wanted seen) seen))))

(defun check-line (number)
  (save-excursion
    (goto-char (point-min))
    (forward-line (1- number))
    (buffer-substring-no-properties (line-beginning-position) (line-end-position))))

(defun check-go (line column)
  (goto-char (point-min))
  (forward-line (1- line))
  (forward-char column))

(defun check-codes ()
  "The codes of the findings, from their texts."
  (sort (mapcar (lambda (found)
                  (let ((text (flymake-diagnostic-text found)))
                    (if (string-match "NC[0-9]+" text) (match-string 0 text) text)))
                (flymake-diagnostics))
        #'string<))

(defun check-request (method &rest more)
  (jsonrpc-request (eglot--current-server-or-lose) method
                   (append (list :textDocument (eglot--TextDocumentIdentifier)) more)))

(defun check-all ()
  (check "mode" (eq major-mode 'din66025-mode) major-mode)
  (check-until "diagnostics" (lambda () (length (flymake-diagnostics))) (lambda (seen) (= seen 2)))
  (check "codes" (equal (check-codes) '("NC054" "NC201")) (check-codes))
  (check-go 12 5)
  (let (text)
    (eglot-hover-eldoc-function (lambda (found &rest _) (setq text found)))
    (check-until "hover" (lambda () (and text (substring-no-properties text)))
                 (lambda (seen) (and seen (string-match-p "G1.*line" seen) (string-match-p "G91" seen)))))
  (let* ((here '(:line 5 :character 4))
         (actions (check-request :textDocument/codeAction :range (list :start here :end here)
                                 :context '(:diagnostics [])))
         (action (seq-find (lambda (one) (equal (plist-get one :title) "Write the letters in upper case"))
                           (append actions nil))))
    (eglot--apply-workspace-edit (plist-get action :edit) nil)
    (check "code action" (equal (check-line 6) "N40 G1 X40 Y20") (check-line 6)))
  (check-until "diagnostics after the fix" #'check-codes (lambda (seen) (equal seen '("NC201"))))
  (check-go 15 10)
  (xref-find-definitions "L90")
  (check "definition" (= (line-number-at-pos) 12) (line-number-at-pos))
  (check-go 12 1)
  (eglot-rename "95")
  (check "rename" (equal (check-line 15) "N120 G20 L95 K$pass$") (check-line 15))
  (goto-char (point-max))
  (insert "n150  g90X1,5")
  (check-until "error while typing" #'check-codes (lambda (seen) (member "NC001" seen)))
  (delete-char -2)
  (check-until "error is gone" #'check-codes (lambda (seen) (not (member "NC001" seen))))
  (eglot-format-buffer)
  (check "format" (equal (check-line 18) "N150 G90 X1") (check-line 18))
  (check-go 18 7)
  (let ((offered (nth 2 (eglot-completion-at-point))))
    (check "completion" (member "G91" (all-completions "" offered)) (substring-no-properties (car (all-completions "" offered)))))
  (let ((hints (check-request :textDocument/inlayHint :range '(:start (:line 0 :character 0) :end (:line 17 :character 0)))))
    (check "inlay hints" (> (length hints) 8) (plist-get (aref hints 0) :label)))
  (let ((index (imenu--make-index-alist t)))
    (check "outline" (string-match-p "finish" (format "%S" index)) (length index))))

(find-file (getenv "PROGRAM"))
(condition-case problem (check-all)
  (error (check "no error" nil problem)))
(with-temp-file (getenv "RESULTS")
  (dolist (line (reverse check-results)) (insert line)))
(set-buffer-modified-p nil)
(kill-emacs 0)
