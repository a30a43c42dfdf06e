// The vote beside a question, where vote.py serves the deck. The telephones show the question of
// the slide that is shown; the bars wait for a key, so that no vote follows another.
import qrcode from 'qrcode-generator';
import css from './vote.css';

const { deck, VOTE: { address, letters, questions } } = window;
const POLL = 1000; // ms
const made = (parent, tag, className, more = {}) =>
    parent.appendChild(Object.assign(document.createElement(tag), { className, ...more }));

class Vote {
  constructor(slide, options) {
    this.slide = slide;
    const page = deck.getSlides()[slide].querySelector('.page'),
        panel = page.querySelector('figure:has(.panel)');
    page.classList.toggle('beside', !panel);
    const box = made(panel ?? page, 'aside', 'vote', { ariaLabel: 'Vote' }), code = qrcode(0, 'M');
    code.addData(address);
    code.make();
    this.bars = made(box, 'div', 'vote-bars');
    this.rows = options.map((text, k) => {
      made(this.bars, 'p', '', { innerHTML: `<b>${letters[k]}</b> ${text}` });
      return [made(made(this.bars, 'span', ''), 'i', ''), made(this.bars, 'span', '')];
    });
    this.code = made(box, 'button', 'vote-code', { type: 'button',
      innerHTML: code.createSvgTag({ cellSize: 4, margin: 16, scalable: true,
        alt: `QR code of ${address}` }), onclick: () => this.code.classList.toggle('large') });
    const side = made(box, 'div', '');
    this.said = made(side, 'p', 'vote-said');
    made(side, 'p', '', { textContent: new URL(address).host });
    const keys = made(side, 'div', 'vote-keys');
    const key = (onclick) => made(keys, 'button', '', { type: 'button', onclick });
    this.reveal = key(() => this.show(this.bars.hidden));
    this.close = key(() => this.act(this.isOpen ? 'close' : 'open'));
    key(() => { this.show(false); this.act('reset'); }).textContent = 'Vote again';
    this.show(false);
  }

  show(bars) {
    this.bars.hidden = !bars;
    this.reveal.textContent = bars ? 'Hide votes (V)' : 'Show votes (V)';
  }

  async act(what) {
    let told;
    try {
      const response = await fetch(`/${what}/${this.slide}`, { method: 'POST' });
      if (!response.ok) throw Error(response.statusText);
      told = await response.json();
    } catch (error) {
      this.said.textContent = `No vote: ${error.message}`;
      return;
    }
    const { counts, open } = told, all = counts.reduce((a, b) => a + b, 0);
    this.isOpen = open;
    this.close.textContent = open ? 'Close (C)' : 'Open again (C)';
    this.said.innerHTML = `<b>${all}</b> ${all === 1 ? 'vote' : 'votes'}${open ? '' : ', closed'}`;
    this.rows.forEach(([bar, count], k) => {
      bar.style.width = `${100 * counts[k] / Math.max(...counts, 1)}%`;
      count.textContent = counts[k];
    });
  }
}

if (window.parent === window) {  // the speaker's window shows other slides too
  document.head.append(Object.assign(document.createElement('style'), { textContent: css }));
  const votes = new Map();
  let shown;
  const arrived = () => {
    const now = votes.get(deck.getIndices().h);
    if (shown && shown !== now) shown.act('leave');
    shown = now;
    shown?.act('ask');
  };
  const key = (keyCode, letter, description, act) =>
      deck.addKeyBinding({ keyCode, key: letter, description }, () => shown && act(shown));
  key(86, 'V', 'Show or hide the votes', (it) => it.reveal.click());
  key(67, 'C', 'Close the vote, or open it again', (it) => it.close.click());
  key(81, 'Q', 'The QR code, large or small', (it) => it.code.click());
  const start = () => {
    for (const [slide, options] of Object.entries(questions))
      votes.set(+slide, new Vote(+slide, options));
    arrived();
    deck.on('slidechanged', arrived);
    dispatchEvent(new Event('resize'));  // the slides are fitted anew
    setInterval(() => shown?.act('counts'), POLL);
  };
  if (deck.isReady()) start();
  else deck.on('ready', start);
}
