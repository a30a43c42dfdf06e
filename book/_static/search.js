// Sphinx's search fetches each page that it found, for the words around; from the disk it may not.
// Here they come out of words.js, without code. The page begins with the paragraph that has most of
// the words asked for, because Sphinx shows the first place that has one of them.
const WORDS = (new URLSearchParams(location.search).get('q') ?? '').toLowerCase()
    .match(/[\p{L}\d]+/gu) ?? [];
const ASKED = [...WORDS, WORDS.join(' ')]; // together they count once more
window.fetch = (url) => {
  const page = PAGES[Object.keys(PAGES).find((it) => url.endsWith(`${it}.html`))] ?? '';
  const parts = page.split('\n');
  const hits = (part) => part.length < 60 ? 0 : // a heading, or the cell of a table
    ASKED.filter((word) => part.toLowerCase().includes(word)).length;
  const best = parts.reduce((most, part, i) => hits(part) > hits(parts[most]) ? i : most, 0);
  const first = parts.slice(best).join(' ').replace(/<[^>]*>/g, '');
  const text = `<div role="main"><p>${first}</p> ${page}</div>`;
  return Promise.resolve({ text: () => Promise.resolve(text) });
};
// Of two pages with a word the one that explains it comes first, and else the one that says it more
// often.
// Before Sphinx's own listener, which searches.
document.addEventListener('DOMContentLoaded', () => Object.assign(globalThis.Scorer, {
  score([name, , , , score]) {
    const page = (PAGES[name] ?? '').toLowerCase();
    const times = (word) => Math.min(page.split(word).length - 1, 40);
    const explained = TERMS[name]?.includes(WORDS.join(' ')) ? 5 : 0;
    return score + explained + ASKED.reduce((sum, word) => sum + times(word), 0) / 4;
  },
}));
