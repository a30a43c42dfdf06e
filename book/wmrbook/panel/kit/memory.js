// What a reader of the book answered, and whether they care to be asked: kept by the browser, from
// a disk too. In a deck nothing is kept, for each lecture asks anew.

const ANSWER = 'wmr-predicted:', NEVER = 'wmr-never-ask';
const kept = () => typeof wmrKit !== 'undefined' && !document.querySelector('.reveal');

function using(act, otherwise) {
  try { return kept() ? act(localStorage) : otherwise; } catch { return otherwise; } // it is barred
}

/** @returns {any} what was answered, or null */
export const recall = (name) =>
    using((store) => JSON.parse(store.getItem(ANSWER + name) ?? 'null'), null);
export const remember = (name, guess) =>
    using((store) => store.setItem(ANSWER + name, JSON.stringify(guess)), undefined);
export const forget = (name) => using((store) => store.removeItem(ANSWER + name), undefined);
export const neverAsk = () => using((store) => store.getItem(NEVER) !== null, false);
export const keepsAnswers = () => using(() => true, false);
export function ask(never) {
  using((store) => (never ? store.setItem(NEVER, '1') : store.removeItem(NEVER)), undefined);
}
export const forgetAll = () => using((store) => {
  for (const key of Object.keys(store))
    if (key.startsWith(ANSWER) || key === NEVER) store.removeItem(key);
}, undefined);
