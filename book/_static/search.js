// Sphinx's search fetches each page that it found, for the words around; from the disk it may not.
// Here they come out of words.js.
window.fetch = (url) => {
  const name = Object.keys(PAGES).find((it) => url.endsWith(`${it}.html`));
  const text = `<div role="main">${PAGES[name] ?? ''}</div>`;
  return Promise.resolve({ text: () => Promise.resolve(text) });
};
