// What is wrong with a deck, of which all slides are laid out: [slide, kind, what] for each
// trouble. Sizes count against the height of a picture of 16 to 9, as wide as the window: in a
// squarer one what limits them is its width. Letters are 24 of 720 high, in words, in stored
// figures and on canvases, on which the test has noted them; only indices may be smaller.
() => {
  const found = [], tallest = Math.min(innerHeight, innerWidth * 9 / 16), least = tallest / 30;
  const sight = (it) => it.closest('aside, mjx-assistive-mml, .wmr-aside') === null
      && it.checkVisibility();
  const size = (it) => parseFloat(getComputedStyle(it).fontSize);
  [...document.querySelectorAll('.page')].forEach((page, count) => {
    const all = (what) => [...page.querySelectorAll(what)].filter(sight);
    const tell = (kind, what = '') => found.push([count + 1, kind, what]);
    const short = (it) => it.outerHTML.replace(/<svg.*?<\/svg>/gs, '').slice(0, 90);

    if (!all('h2').some((it) => it.textContent.trim())) tell('no title');
    for (const picture of all('figure img, .live-panes, .wmr-stage canvas, .stage-view')) {
      const { width, height } = picture.getBoundingClientRect(),
          { naturalWidth, naturalHeight } = picture;
      const tall = naturalWidth ? Math.min(height, width * naturalHeight / naturalWidth) : height;
      const share = tall / tallest;
      if (share < 0.6) tell('small picture', `${(100 * share).toFixed(1)} %`);
      // matplotlib draws letters of 100 units, scaled to points, of which a pixel has 0.75
      const drawn = decodeURIComponent(picture.src || '').matchAll(/scale\(([\d.]+) -/g),
          points = Math.min(...[...drawn].map((it) => 100 * Number(it[1]))),
          letters = points * tall / naturalHeight / 0.75;
      if (letters < least - 0.05) tell('small letters', `${letters.toFixed(1)} px`);
    }

    for (const canvas of all('canvas'))
      for (const [text, high] of canvas.letters || [])
        if (high < least - 0.05) tell('small letters', `${high.toFixed(1)} px: ${text}`);

    const texts = document.createTreeWalker(page, NodeFilter.SHOW_TEXT), small = new Set();
    while (texts.nextNode()) {
      const it = texts.currentNode.parentElement;
      if (!texts.currentNode.data.trim() || !sight(it) || it.closest('mjx-container, script, sub'))
        continue;
      if (size(it) < least - 0.01)
        small.add(`${it.tagName} ${size(it).toFixed(1)}`);
    }
    for (const it of all('mjx-container'))
      if (size(it) < least - 0.01) small.add(`formula ${size(it).toFixed(1)}`);
    if (small.size) tell('small text', [...small].join(', '));

    for (const it of all('.body, .words, .live, .wmr-stage'))
      if (it.scrollHeight > it.clientHeight + 1 || it.scrollWidth > it.clientWidth + 1)
        tell('overflow', short(it));
    const low = innerHeight - 0.5 * parseFloat(getComputedStyle(document.documentElement).fontSize);
    const parts = all('p, li, img, h2, td, th, mjx-container, canvas, input, select, button')
      .filter((it) => !it.querySelector('p, li'));
    const boxes = parts.map((it) => [it, it.getBoundingClientRect()]);
    const out = boxes.filter(([, box]) => box.width
        && (box.left < -1 || box.top < -1 || box.right > innerWidth + 1 || box.bottom > low));
    if (out.length) tell('outside', out.map(([it]) => short(it)).join(' '));
    const still = boxes.filter(([it]) => !it.closest('.panel'));
    still.forEach(([one, a], at) => still.slice(at + 1).forEach(([two, b]) => {
      const over = Math.min(Math.min(a.right, b.right) - Math.max(a.left, b.left),
          Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top));
      if (over > 4 && !one.contains(two))
        tell('overlap', `${over.toFixed(0)} px: ${short(one)} | ${short(two)}`);
    }));
  });
  return found;
}
