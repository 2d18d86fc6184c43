// @ts-check
// What lies over the drawing is drawn of: the colours of the style sheet, and lines from point to point.

/** The colours, as the style sheet has them now, each by its name there. */
export function colours() {
    const style = getComputedStyle(document.documentElement);
    const of = (/** @type {string} */ name) => style.getPropertyValue(`--${name}`).trim();
    return {
        accent: of("accent"),
        bad: of("bad"),
        edge: of("edge"),
        ground: of("ground"),
        line: of("line"),
        panel: of("panel"),
        quiet: of("quiet"),
        text: of("text"),
        warn: of("warn"),
    };
}

/** Begin a path of lines through points. @param {CanvasRenderingContext2D} context @param {(readonly [number, number])[]} points */
export function path(context, ...points) {
    context.beginPath();
    points.forEach(([x, y], k) => context[k ? "lineTo" : "moveTo"](x, y));
}

/** The same, drawn. @param {CanvasRenderingContext2D} context @param {(readonly [number, number])[]} points */
export function line(context, ...points) {
    path(context, ...points);
    context.stroke();
}

/** Begin a path around a point. @param {CanvasRenderingContext2D} context @param {readonly [number, number]} at @param {number} radius */
export function ring(context, [x, y], radius) {
    context.beginPath();
    context.arc(x, y, radius, 0, 2 * Math.PI);
}
