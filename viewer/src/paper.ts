// Sizes on paper: A4 within margins of 14 mm, in two columns; see `@media print` in page.css.

/** Width of a column, height of the drawing, px of 1/96 in; and points of the drawing's canvas to each. */
export const PAPER = { column: 333, drawing: 234, ratio: 3 };
