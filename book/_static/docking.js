// A chapter's stage stays beside its text where the window is wide enough, and shows the scene
// that the section being read names. Elsewhere it opens the chapter, and returns where a section
// shows it again; to every other section that names a scene a button brings it.
addEventListener('DOMContentLoaded', () => {
  const article = document.querySelector('.bd-article'),
      sections = [...(article?.querySelectorAll('section[class*="stage-"]') || [])],
      cell = article?.querySelector('.cell.tag_stage');
  if (!cell || sections.length < 2) return; // a single scene needs no place of its own
  const wide = matchMedia('screen and (min-width: 1240px)'), root = document.documentElement,
      list = document.querySelector('#pst-primary-sidebar');
  const sceneOf = (section) => section.className.match(/\bstage-(\S+)/)[1];
  let stage = null, shown = null, brought = null; // to which section

  // The section that is read: the one that the address names while it stands at the window's head,
  // otherwise the last whose beginning is above the middle. Before the first one, and where the
  // stage is not beside the text, it is as the chapter opens.
  const read = () => {
    const top = (it) => it.getBoundingClientRect().top / innerHeight,
        named = sections.find((it) => `#${it.id}` === location.hash);
    const now = named && Math.abs(top(named) - 0.1) < 0.15 ? named :
      sections.filter((it) => top(it) < 0.45).at(-1);
    if (wide.matches) return now ? sceneOf(now) : stage.opening;
    return brought ? sceneOf(brought) : stage.opening;
  };
  const follow = () => {
    if (!stage) return;
    const now = read();
    if (now !== shown) stage.show(now);
    shown = now;
  };
  // Where the stage is not beside the text, a section without one of its own can have it.
  const buttons = [];
  const bring = (button, section = null) => {
    button.after(cell);
    brought = section;
    for (const it of buttons) it.hidden = it === button;
    follow();
  };
  const putButton = (head, section) => {
    const button = document.createElement('button');
    Object.assign(button, { type: 'button', className: 'bring-stage', hidden: !section,
      textContent: 'Show it on the stage' });
    button.addEventListener('click', () => {
      const { top } = head.getBoundingClientRect();
      bring(button, section);
      // the text stays where it is read, wherever the stage came from
      scrollBy({ top: head.getBoundingClientRect().top - top, behavior: 'instant' });
      cell.querySelector('.stage-tools button')?.focus({ preventScroll: true });
    });
    head.after(button);
    buttons.push(button);
    return button;
  };
  const hideList = () => list?.classList.toggle('pst-sidebar-hidden', wide.matches);
  const dock = () => {
    hideList();
    if (wide.matches && brought) bring(home);
    root.classList.toggle('docked', wide.matches);
    cell.classList.toggle('docked-stage', wide.matches);
    follow();
  };
  const begin = () => {
    ({ stage = null } = cell.querySelector('.wmr.stage') || {});
    if (!stage) return false;
    shown = stage.opening;
    follow();
    return true;
  };
  const home = putButton(cell.previousElementSibling || article.querySelector('h1'));
  for (const section of sections) {
    const head = section.querySelector(':scope > :is(h2, h3, h4)');
    if (head && !section.querySelector(':scope > .cell.tag_stage')) putButton(head, section);
  }
  // At once, before the browser goes to the place that an address names.
  dock();
  wide.addEventListener('change', dock);
  addEventListener('afterprint', dock); // without a change of width
  addEventListener('scroll', () => requestAnimationFrame(follow), { passive: true });
  addEventListener('keydown', ({ key }) => {
    if (key === 'Escape' && root.classList.contains('docked')) hideList();
  });
  if (begin()) return;
  const waits = new MutationObserver(() => { if (begin()) waits.disconnect(); });
  waits.observe(cell, { childList: true, subtree: true });
});
