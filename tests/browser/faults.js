// What a reader of this page, at this width, would not see or could not use: sentences by kind.
() => {
  const found = {};
  const note = (kind, text) =>
      (found[kind] ??= []).push(text.trim().replace(/\s+/g, ' ').slice(0, 60));
  const article = document.querySelector('article') ?? document.body;
  const seen = (it) => it.checkVisibility() && it.getClientRects().length > 0;
  const scrolls = (it) => /auto|scroll/.test(getComputedStyle(it).overflowX);
  const clips = (it) => getComputedStyle(it).overflowX !== 'visible'
      && getComputedStyle(it).display !== 'inline';

  // From left to right what those around an element leave to be seen of it, at once or by
  // scrolling.
  function window_of(element, scrolling = true) {
    let [left, right] = [0, document.documentElement.clientWidth];
    for (let it = element.parentElement; it && it !== document.body; it = it.parentElement) {
      if (!clips(it)) continue;
      const box = it.getBoundingClientRect();
      if (scrolling && scrolls(it)) {
        const [from, to] = window_of(it);
        const start = box.left + it.clientLeft - it.scrollLeft;
        return box.left < from - 1 || box.right > to + 1 ? [from, to]
            : [start, start + it.scrollWidth];
      }
      left = Math.max(left, box.left);
      right = Math.min(right, box.right);
    }
    return [left, right];
  }

  // The words to be seen in an element, with the boxes that they are drawn in: two for one that is
  // torn.
  function* words(element, shape) {
    const walker = document.createTreeWalker(element, NodeFilter.SHOW_TEXT);
    const range = document.createRange();
    while (walker.nextNode()) {
      const { data, parentElement } = walker.currentNode;
      if (parentElement.closest('mjx-container, script, style')) continue;
      for (const { 0: text, index } of data.matchAll(shape)) {
        range.setStart(walker.currentNode, index);
        range.setEnd(walker.currentNode, index + text.length);
        yield { text, boxes: range.getClientRects() };
      }
    }
  }

  for (const block of article.querySelectorAll('pre')) {
    if (!seen(block)) continue;
    // What is printed may scroll in its box, which is to be seen then; what is typed has to be seen
    // at once.
    const edge = window_of(block, false)[1], box = block.getBoundingClientRect();
    if (block.closest('.cell_output') && scrolls(block)) {
      if (box.right > edge + 1) note('outputs cut', block.textContent);
      continue;
    }
    const right = Math.min(edge, box.right);
    const cut = new Set();
    for (const word of words(block, /\S+/g)) {
      for (const box of word.boxes) if (box.right > right + 1) cut.add(Math.round(box.top));
    }
    for (const top of cut) note('code lines cut', `${block.textContent.slice(0, 40)} at ${top}`);
  }

  for (const formula of article.querySelectorAll('mjx-container > svg')) {
    if (!seen(formula) || formula.closest('.jupyter-widgets')) continue;
    const said = formula.parentElement.textContent;
    // What is drawn: a formula with a number is as wide as its line, its parts need not be.
    let [left, right] = [Infinity, -Infinity];
    for (const part of formula.querySelectorAll('use, rect, path, text')) {
      const box = part.getBoundingClientRect();
      if (box.width > 0) [left, right] = [Math.min(left, box.left), Math.max(right, box.right)];
    }
    const [from, to] = window_of(formula);
    if (left < from - 1) note('equations without their left edge', said);
    if (right > to + 1) note('equations beyond their box', said);
    if (!formula.parentElement.querySelector('mjx-assistive-mml math'))
      note('formulas without a spoken text', said);
  }

  for (const table of article.querySelectorAll('table')) {
    if (!seen(table) || table.closest('.jupyter-widgets')) continue;
    const [from, to] = window_of(table);
    const box = table.getBoundingClientRect();
    if (box.left < from - 1 || box.right > to + 1) note('tables cut', table.textContent);
  }

  const over = document.documentElement.scrollWidth - document.documentElement.clientWidth;
  if (over > 1) note('pages wider than the window', `${over} pixels`);

  for (const image of article.querySelectorAll('img')) {
    if (!seen(image)) continue;
    const [from, to] = window_of(image);
    const box = image.getBoundingClientRect();
    if (box.left < from - 1 || box.right > to + 1) note('figures cut', image.alt);
    // Its caption is the next paragraph in the text, and says its number.
    const cell = image.closest('.cell') ?? image;
    const after = cell.nextElementSibling;
    if (!image.closest('figure')?.querySelector('.caption-number')
        && !/^Figure \d+(\.\d+)?\./.test(after?.textContent.trim() ?? '')) {
      note('figures without number and caption', image.alt);
    }
  }
  return found;
}
