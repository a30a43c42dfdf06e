// What is wrong with a deck, of which all slides are laid out: [slide, kind, what] for each
// trouble. Sizes count against the height of a picture of 16 to 9, as wide as the window: in a
// squarer one what limits them is its width.
() => {
  const found = [], tallest = Math.min(innerHeight, innerWidth * 9 / 16);
  const sight = (it) => it.closest('aside, details, mjx-assistive-mml') === null
      && it.checkVisibility();
  const words = (it) => {
    const copy = it.cloneNode(true);
    for (const formula of copy.querySelectorAll('mjx-container'))
      formula.replaceWith(formula.getAttribute('display') ? '' : 'x');
    return copy.textContent.split(/\s+/).filter((word) => /\w/.test(word)).length;
  };
  const height = (box) => box.bottom - box.top;
  [...document.querySelectorAll('.page')].forEach((page, count) => {
    const all = (what) => [...page.querySelectorAll(what)].filter(sight);
    const tell = (kind, what = '') => found.push([count + 1, kind, what]);
    const short = (it) => it.outerHTML.replace(/<svg.*?<\/svg>/gs, '').slice(0, 90);

    if (!all('h1, h2, h3').some((it) => it.textContent.trim())) tell('no title');
    const prose =
        all('p, li').filter((it) => !it.closest('.output, .panel') && !it.querySelector('p, li'));
    if (!prose.some((it) => words(it) > 3) && !all('table, .live').length)
      tell('no sentence',
          all('.output, .panel, figure').length ? 'only output or code' : 'only a title');
    const total =
        prose.filter((it) => !it.closest('.caption')).map(words).reduce((a, b) => a + b, 0);
    if (total > 60) tell('many words', total);

    for (const image of all('figure img')) {
      const box = image.getBoundingClientRect();
      const tall = Math.min(height(box), box.width * image.naturalHeight / image.naturalWidth);
      if (tall < 0.45 * tallest) tell('small figure', `${(100 * tall / tallest).toFixed(0)} %`);
    }

    const texts = document.createTreeWalker(page, NodeFilter.SHOW_TEXT);
    const small = new Set();
    while (texts.nextNode()) {
      const it = texts.currentNode.parentElement;
      if (!texts.currentNode.data.trim() || !sight(it)
          || it.closest('summary, .panel, mjx-container, script')) continue;
      const size = parseFloat(getComputedStyle(it).fontSize);
      if (size < tallest / 40 - 0.01)
        small.add(`${it.closest('pre, p, li, td, th')?.tagName} ${size.toFixed(1)}`);
    }
    for (const it of all('mjx-container')) {
      const size = parseFloat(getComputedStyle(it).fontSize);
      if (size < tallest / 40 - 0.01) small.add(`formula ${size.toFixed(1)}`);
    }
    if (small.size) tell('small text', [...small].join(', '));

    const low = innerHeight - 0.5 * parseFloat(getComputedStyle(document.documentElement).fontSize);
    const parts =
        all('p, li, img, pre, h1, h2, h3, td, th, mjx-container[display], canvas, select, button')
      .filter((it) => !it.closest('.output_markdown')
          && !it.querySelector('p, li, mjx-container[display]'));
    const out = parts.filter((it) => {
      const box = it.getBoundingClientRect();
      return box.width
          && (box.left < -1 || box.top < -1 || box.right > innerWidth + 1 || box.bottom > low);
    });
    if (out.length) tell('outside', out.map(short).join(' '));
    else if (page.scrollHeight > innerHeight + 1 || page.scrollWidth > innerWidth + 1)
      tell('outside', 'the page');

    const boxes =
        parts.filter((it) => !it.closest('.panel')).map((it) => [it, it.getBoundingClientRect()]);
    boxes.forEach(([one, a], at) => boxes.slice(at + 1).forEach(([two, b]) => {
      const over = Math.min(Math.min(a.right, b.right) - Math.max(a.left, b.left),
          Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top));
      if (over > 2 && !one.contains(two))
        tell('overlap', `${over.toFixed(0)} px: ${short(one)} | ${short(two)}`);
    }));
  });
  return found;
}
