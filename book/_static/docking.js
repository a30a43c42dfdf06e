// A chapter's stage stays beside its text where the window is wide enough, and shows the scene
// that the section being read names. Elsewhere it opens the chapter, and returns where a section
// shows it again.
addEventListener('DOMContentLoaded', () => {
  const article = document.querySelector('.bd-article');
  const sections = [...(article?.querySelectorAll('section[class*="stage-"]') || [])];
  if (sections.length < 2) return; // a single scene needs no place of its own
  const wide = matchMedia('screen and (min-width: 1240px)'), root = document.documentElement;
  const sceneOf = (section) => section.className.match(/\bstage-(\S+)/)[1];
  let cell, stage, shown = null;

  // The section that is read: the last whose beginning is above the middle of the window.
  const read = () => {
    const above = sections.filter((it) =>
      it.getBoundingClientRect().top < 0.45 * innerHeight);
    return above.length ? sceneOf(above.at(-1)) : '';
  };
  const follow = () => {
    if (!wide.matches || !stage) return;
    const now = read();
    if (now === shown) return;
    shown = now;
    stage.show(now || stage.scenes[0]);
  };
  const dock = () => {
    document.querySelector('#pst-primary-sidebar')?.classList
        .toggle('pst-sidebar-hidden', wide.matches);
    root.classList.toggle('docked', wide.matches);
    cell.classList.toggle('docked-stage', wide.matches);
    shown = wide.matches ? shown : null;
    follow();
  };
  const begin = () => {
    const first = article.querySelector('.wmr.stage');
    if (!first?.stage) return false;
    stage = first.stage;
    cell = first.closest('.cell');
    shown = ''; // as it opens
    dock();
    wide.addEventListener('change', dock);
    addEventListener('scroll', () => requestAnimationFrame(follow), { passive: true });
    return true;
  };
  if (begin()) return;
  const waits = new MutationObserver(() => { if (begin()) waits.disconnect(); });
  waits.observe(article, { childList: true, subtree: true });
});
