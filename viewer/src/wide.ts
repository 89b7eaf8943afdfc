// Boxes that scroll within the page, with a shade where there is more.

import { h } from './dom';

/** Puts a box that scrolls into a frame that shows on which sides there is more; it is as high as some pixels of whole rows at most. */
export function wide(box: HTMLElement, height?: number): HTMLElement {
  const frame = h('div', { class: 'wide' }, box);
  const look = () => {
    const { scrollLeft, scrollWidth, clientWidth, offsetHeight, clientHeight } = box;
    const first = box.querySelector('th')?.getBoundingClientRect();
    frame.style.setProperty('--first', `${first ? Math.round(first.width) + 1 : 1}px`);
    frame.classList.toggle('more-left', scrollLeft > 1);
    frame.classList.toggle('more-right', scrollLeft + clientWidth < scrollWidth - 1);
    // what the bar takes must not cut a row
    if (height !== undefined && clientHeight > 0) box.style.maxHeight = `${height + offsetHeight - clientHeight}px`;
  };
  box.addEventListener('scroll', look, { passive: true });
  const seen = new ResizeObserver(look);
  seen.observe(box);
  if (box.firstElementChild) seen.observe(box.firstElementChild);
  return frame;
}
