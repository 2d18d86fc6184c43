// @ts-check
// What a search for designs that fit an outline says, and the order in which they are shown.

/**
 * @typedef {object} Fit a design whose tile comes near to the outline
 * @property {"fit"} type
 * @property {string} group
 * @property {number} overlap of tile and outline: the area they have in common over that of both together
 * @property {number} distance how far they are apart at most; millimetres
 * @property {number} corners of its stroke
 * @property {boolean} symmetric whether the tile is its own mirror image
 * @property {any} design
 * @property {string} picture SVG
 * @property {any} art the table of its art, null where nothing else is drawn
 * @property {number} [number] what its art is asked for by
 * @property {string[]} notes
 */

/**
 * The messages in a stream of lines of JSON, as they come.
 * @param {ReadableStream<Uint8Array>} stream
 * @returns {AsyncGenerator<any, void>}
 */
export async function* messagesOf(stream) {
    const reader = stream.getReader();
    const decoder = new TextDecoder();
    let rest = "";
    for (let part = await reader.read(); !part.done; part = await reader.read()) {
        const lines = (rest + decoder.decode(part.value, { stream: true })).split("\n");
        rest = lines.pop() ?? "";
        for (const line of lines) {
            yield JSON.parse(line);
        }
    }
}

/**
 * Designs, the nearest first, with another one, and its place among them.
 * @param {readonly Fit[]} fits
 * @param {Fit} fit
 */
export function withFit(fits, fit) {
    const after = fits.findIndex(({ overlap }) => overlap < fit.overlap);
    const place = after < 0 ? fits.length : after;
    return { fits: [...fits.slice(0, place), fit, ...fits.slice(place)], place };
}

/**
 * A design with its art.
 * @template {{site: readonly any[]}} Design
 * @param {Design} design
 * @param {any} art as a design file has it
 * @returns {Design}
 */
export const withArt = (design, art) => ({
    ...design,
    site: design.site.map((site, k) => (k ? site : { ...site, art })),
});
