// @ts-check
// Designs in links: the whole design stands behind the #, which browsers send to nobody.

/** The address that opens a design in a studio that runs here. @param {import("./model/design.js").Design} design */
export function linkOf(design) {
    const bytes = new TextEncoder().encode(JSON.stringify(design));
    const binary = Array.from(bytes, (byte) => String.fromCharCode(byte)).join("");
    return `${location.origin}/#design=${btoa(binary).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "")}`;
}

/**
 * The design in a link. Throws an Error for people where there is none.
 * @param {string} text
 * @param {{strokes: number, points: number}} limits the most that the studio takes
 * @returns {import("./model/design.js").Design}
 */
export function sharedDesign(text, limits) {
    const code = text.match(/#design=([\w-]*)/)?.[1] ?? "";
    /** @type {any} */
    let design = null;
    try {
        const binary = atob(code.replaceAll("-", "+").replaceAll("_", "/"));
        design = JSON.parse(
            new TextDecoder("utf-8", { fatal: true }).decode(Uint8Array.from(binary, (one) => one.charCodeAt(0))),
        );
    } catch {
        // Said below.
    }
    if (!isDrawable(design)) {
        throw new Error("The link holds no design that can be read. It may have been cut off: ask for it again.");
    }
    const strokes = design.site.flatMap((/** @type {any} */ site) => site.strokes);
    const points = strokes
        .flatMap((/** @type {any} */ stroke) => Object.values(stroke))
        .reduce(
            (/** @type {number} */ sum, /** @type {any} */ value) => sum + (Array.isArray(value) ? value.length : 0),
            0,
        );
    if (strokes.length > limits.strokes || points > limits.points) {
        const has = `${strokes.length.toLocaleString("en")} strokes with ${points.toLocaleString("en")} points`;
        throw new Error(
            `The design in the link is too large for the studio: ${has}. The command line takes designs of any size.`,
        );
    }
    return design;
}

/**
 * Whether something has what this page needs to draw it; whether it is a design that can be tiled the server says.
 * @param {any} design
 */
function isDrawable(design) {
    const table = (/** @type {any} */ value) => typeof value === "object" && value !== null && !Array.isArray(value);
    return (
        table(design) &&
        table(design.cell) &&
        Number.isFinite(design.cell.a) &&
        typeof design.group === "string" &&
        Array.isArray(design.site) &&
        design.site.length > 0 &&
        design.site.every(
            (/** @type {any} */ site) => table(site) && Array.isArray(site.strokes) && site.strokes.every(table),
        )
    );
}
