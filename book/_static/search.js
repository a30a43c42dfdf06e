// Sphinx's search fetches each page that it found, for the words around; from the disk it may not.
// Here they come out of words.js.
window.fetch = (url) => {
  const name = Object.keys(PAGES).find((it) => url.endsWith(`${it}.html`));
  const text = `<div role="main">${PAGES[name] ?? ''}</div>`;
  return Promise.resolve({ text: () => Promise.resolve(text) });
};
// Of two pages with a word the one that says it more often comes first.
// Before Sphinx's own listener, which searches.
document.addEventListener('DOMContentLoaded', () => Object.assign(globalThis.Scorer, {
  score([name, , , , score]) {
    const asked = new URLSearchParams(location.search).get('q') ?? '';
    const words = asked.toLowerCase().match(/[\p{L}\d]+/gu) ?? [];
    const page = (PAGES[name] ?? '').toLowerCase();
    const times = (word) => Math.min(page.split(word).length - 1, 40);
    return score + words.reduce((sum, word) => sum + times(word), 0) / 4;
  },
}));
