// What each program is to the page that shows it.

import { CONTRACTS } from './contracts.js';

// JupyterLab counts a notebook as changed as soon as it finds the widgets that are stored in it.
// Before somebody edits or runs it, it is not.
function opensUnchanged({ model }) {
  const notebook = model.widget_manager?.context?.model, kind = 'application/vnd.jupyter.widget';
  if (!notebook || notebook.sharedModel.canUndo()) return;
  const stored = notebook.getMetadata('widgets')?.[`${kind}-state+json`]?.state || {};
  const outputs = [...notebook.cells].flatMap((cell) => cell.sharedModel.toJSON().outputs || []);
  if (outputs.every(({ data }) => !data?.[`${kind}-view+json`]
      || data[`${kind}-view+json`].model_id in stored)) notebook.dirty = false;
}

/**
 * `render` is called only with a state of the contract that the program was written for.
 * @param {string} program @param {(context: Context) => (() => void) | void} render
 * @param {(model: Model) => void} begin once for all views of a model
 */
export const widget = (program, render, begin = () => {}) => ({
  initialize(context) {
    opensUnchanged(context);
    begin(context.model);
  },
  render(context) {
    if (context.model.get('contract') === CONTRACTS[program]) return render(context);
    context.el.textContent =
        'Another version of the book has stored this panel: run its cell again.';
    return undefined;
  },
});
