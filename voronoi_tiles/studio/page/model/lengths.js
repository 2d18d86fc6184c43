// @ts-check
/** Lengths as people write and read them: sums and products of numbers with units. */

/** @typedef {import("./design.js").Unit} Unit */

/** Millimetres in each unit. @type {Readonly<Record<Unit, number>>} */
export const MILLIMETRES = Object.freeze({ mm: 1, cm: 10, in: 25.4 });
