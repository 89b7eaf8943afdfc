// Sizes on paper: A4 within margins of 14 mm, in two columns; see `@media print` in page.css.

/** Widths of a page and of a column, least and largest height of the drawing and what of it is not for the mechanism, px of 1/96 in; and points of the drawing's canvas to each. */
export const PAPER = { width: 688, column: 333, height: [190, 300], room: 60, ratio: 3 } as const;
