// The editor of a cell, by CodeMirror. It stands over the cell's textarea, which holds the code for
// whoever asks, and is all that there is where this script is missing.
import { defaultKeymap, history, historyKeymap, indentWithTab } from '@codemirror/commands';
import { pythonLanguage } from '@codemirror/lang-python';
import { bracketMatching, indentUnit, syntaxHighlighting } from '@codemirror/language';
import { EditorView, keymap, lineNumbers } from '@codemirror/view';
import { classHighlighter } from '@lezer/highlight';

export function dress(area) {
  const attributes = { autocapitalize: 'off' };
  for (const it of ['aria-label', 'aria-describedby']) attributes[it] = area.getAttribute(it);
  const view = new EditorView({
    doc: area.value,
    extensions: [
      lineNumbers(), history(), pythonLanguage, indentUnit.of('    '), bracketMatching(),
      syntaxHighlighting(classHighlighter), EditorView.lineWrapping,
      // After Escape, CodeMirror leaves the next Tab to the browser.
      keymap.of([...defaultKeymap, ...historyKeymap, indentWithTab]),
      EditorView.contentAttributes.of(attributes),
      EditorView.updateListener.of(({ docChanged, state }) => {
        if (!docChanged) return;
        area.value = state.doc.toString();
        area.dispatchEvent(new Event('input'));
      }),
    ],
  });
  area.addEventListener('input', () => {
    const { doc } = view.state;
    if (doc.toString() !== area.value)
      view.dispatch({ changes: { from: 0, to: doc.length, insert: area.value } });
  });
  const focused = document.activeElement === area;
  area.hidden = true;
  area.after(view.dom);
  area.focus = () => view.focus();
  if (focused) view.focus();
}
