// @ts-check
/**
 * The design as the page holds it, and its edits.
 *
 * A design is the plain object that its file is, in the same keys. Edits are pure functions: they give a new object
 * that shares what has not changed, and keep keys that they do not know.
 */

import { MILLIMETRES } from "./lengths.js";
import { placementIn, kindOf, pointsOf } from "./strokes.js";
import { inverse, tidyPlus, tidyProduct, turned } from "./plane.js";

/** @import { Point } from "./plane.js" */
/**
 * @typedef {"point" | "segment" | "polyline" | "bezier" | "hermite" | "catmull_rom" | "bspline" | "circle" | "path" |
 * "file"} StrokeKind
 */
/** @typedef {"mm" | "cm" | "in"} Unit */

/**
 * The keys that place strokes, sites and art, applied in this order about the origin.
 * @typedef {object} Placed
 * @property {boolean} [mirror] x -> -x
 * @property {number} [scale]
 * @property {number} [rotate] degrees, counterclockwise
 * @property {Point} [translate]
 */

/**
 * The keys of a stroke, one of the kinds among them.
 * @typedef {object} StrokeKeys
 * @property {Point} [point]
 * @property {Point[]} [segment]
 * @property {Point[]} [polyline]
 * @property {Point[]} [bezier] 3 n + 1 control points
 * @property {Point[]} [hermite]
 * @property {Point[]} [tangents] beside `hermite`: one for each point
 * @property {Point[]} [catmull_rom]
 * @property {number} [alpha]
 * @property {Point[]} [bspline]
 * @property {Point} [circle]
 * @property {number} [radius]
 * @property {boolean} [closed]
 * @property {string} [path] SVG path data, y up
 * @property {string} [file]
 * @property {string} [layer]
 * @property {string} [id]
 */

/** @typedef {Readonly<StrokeKeys & Placed>} Stroke */

/**
 * @typedef {object} SiteKeys
 * @property {string} [name]
 * @property {number} [tolerance]
 * @property {readonly Stroke[]} strokes
 * @property {string | Readonly<{file: string} & Placed>} [art]
 */

/** @typedef {Readonly<SiteKeys & Placed>} Site */
/** @typedef {Readonly<{a: number, b?: number, angle?: number}>} Cell */

/**
 * What moves on the way up.
 * @typedef {object} SolidKeys
 * @property {number} height
 * @property {number} [layers]
 * @property {number} [turn] degrees
 * @property {Point} [shift]
 * @property {number} [scale]
 * @property {Point} [about]
 */

/** @typedef {Readonly<SolidKeys>} Standing */
/** @typedef {Readonly<{z: number, site?: string, strokes: readonly Stroke[]}>} KeyDrawing */

/**
 * @typedef {object} DesignKeys
 * @property {number} schema
 * @property {string} group
 * @property {Unit} [units]
 * @property {number} [scale]
 * @property {Cell} cell
 * @property {readonly Site[]} site
 * @property {Standing} [solid]
 * @property {readonly KeyDrawing[]} [key]
 */

/** @typedef {Readonly<DesignKeys>} Design */

/** @typedef {Readonly<{site: number, stroke: number}>} Ref a stroke, by the numbers of its site and of itself */
/** @typedef {Readonly<Ref & {node: number}>} NodeRef a node of a stroke */

/**
 * The stroke of a reference, undefined where there is none.
 * @type {(design: Design, ref: Ref) => Stroke | undefined}
 */
export const strokeAt = (design, ref) => design.site[ref.site]?.strokes[ref.stroke];

/** Whether two references mean the same stroke. @type {(one: Ref, other: Ref) => boolean} */
export const isSameStroke = (one, other) => one.site === other.site && one.stroke === other.stroke;

/** Whether two references mean the same node. @type {(one: NodeRef, other: NodeRef) => boolean} */
export const isSameNode = (one, other) => isSameStroke(one, other) && one.node === other.node;

/**
 * The design with strokes added to sites, each a little beside where it was, and the references of the new ones.
 * @param {Design} design
 * @param {readonly {site: number, stroke: Stroke}[]} strokes
 * @param {number} by to the right and down; units
 * @returns {{design: Design, refs: Ref[]}}
 */
export function copied(design, strokes, by) {
    /** @type {Ref[]} */
    const refs = [];
    for (const { site, stroke } of strokes) {
        refs.push({ site, stroke: design.site[site].strokes.length });
        design = addStroke(design, site, stroke);
    }
    return { design: moveStrokes(design, refs, [by, -by]), refs };
}

/**
 * The design with another list of strokes in one site.
 * @type {(design: Design, site: number, edit: (strokes: readonly Stroke[]) => readonly Stroke[]) => Design}
 */
function withStrokes(design, site, edit) {
    return withSite(design, site, (old) => ({ ...old, strokes: edit(old.strokes) }));
}

/**
 * The design with one site changed; itself where there is no such site.
 * @type {(design: Design, index: number, edit: (site: Site) => Site) => Design}
 */
export function withSite(design, index, edit) {
    if (!design.site[index]) return design;
    return { ...design, site: design.site.map((site, k) => (k === index ? edit(site) : site)) };
}

/**
 * The design with a stroke after the others of a site; its reference is {site, stroke: how many there were}.
 * @param {Design} design
 * @param {number} site
 * @param {Stroke} stroke
 * @returns {Design}
 */
export const addStroke = (design, site, stroke) => withStrokes(design, site, (strokes) => [...strokes, stroke]);

/**
 * The design without some strokes; sites stay, also without any.
 * @type {(design: Design, refs: readonly Ref[]) => Design}
 */
export function removeStrokes(design, refs) {
    return [...new Set(refs.map((ref) => ref.site))].reduce((found, site) => {
        const gone = new Set(refs.filter((ref) => ref.site === site).map((ref) => ref.stroke));
        return withStrokes(found, site, (strokes) => strokes.filter((_, k) => !gone.has(k)));
    }, design);
}

/**
 * The design with a stroke in the place of another, or with several, or none.
 * @type {(design: Design, ref: Ref, stroke: Stroke | readonly Stroke[]) => Design}
 */
export function replaceStroke(design, ref, stroke) {
    const inPlace = /** @type {readonly Stroke[]} */ (Array.isArray(stroke) ? stroke : [stroke]);
    return withStrokes(design, ref.site, (strokes) =>
        strokes.flatMap((old, k) => (k === ref.stroke ? inPlace : [old])),
    );
}

/**
 * The design with some strokes moved by a vector of the drawing.
 * @type {(design: Design, refs: readonly Ref[], vector: Point) => Design}
 */
export function moveStrokes(design, refs, vector) {
    return refs.reduce((found, ref) => {
        const stroke = strokeAt(found, ref);
        return stroke ? replaceStroke(found, ref, movedStroke(found.site[ref.site], stroke, vector)) : found;
    }, design);
}

/**
 * A stroke of a site moved by a vector of the drawing: by its points, or by its `translate` where it is placed by keys
 * of its own or has no points.
 * @type {(site: Site, stroke: Stroke, vector: Point) => Stroke}
 */
function movedStroke(site, stroke, vector) {
    const by = turned(inverse(placementIn(site)), vector);
    const isPlaced = ["mirror", "scale", "rotate", "translate"].some((key) => key in stroke);
    if (isPlaced || !pointsOf(stroke).length) return { ...stroke, translate: tidyPlus(stroke.translate ?? [0, 0], by) };
    return mapPoints(stroke, (point) => tidyPlus(point, by));
}

/**
 * A stroke with other points: those of its own key, not the tangents.
 * @type {(stroke: Stroke, map: (point: Point, index: number) => Point) => Stroke}
 */
export function mapPoints(stroke, map) {
    const kind = kindOf(stroke);
    const points = pointsOf(stroke).map(map);
    return points.length ? { ...stroke, [kind]: kind === "point" || kind === "circle" ? points[0] : points } : stroke;
}

/**
 * The design with an empty site after the others, under the next name that is free.
 * @type {(design: Design, strokes?: readonly Stroke[]) => Design}
 */
export function addSite(design, strokes = []) {
    const taken = new Set(siteNames(design));
    let number = design.site.length + 1;
    while (taken.has(`site${number}`)) number++;
    return { ...design, site: [...design.site, { name: `site${number}`, strokes }] };
}

/** The names of all sites. @type {(design: Design) => string[]} */
export const siteNames = (design) => design.site.map((site, k) => site.name ?? `site${k + 1}`);

/** The design without a site. @type {(design: Design, index: number) => Design} */
export function removeSite(design, index) {
    return { ...design, site: design.site.filter((_, k) => k !== index) };
}

/**
 * The design with a site renamed; `nameProblem` says which names there can be.
 * @param {Design} design
 * @param {number} index
 * @param {string} name
 * @returns {Design}
 */
export const renameSite = (design, index, name) => withSite(design, index, (site) => ({ ...site, name: name.trim() }));

/**
 * Why a site cannot have a name; null where it can.
 * @type {(design: Design, index: number, name: string) => string | null}
 */
export function nameProblem(design, index, name) {
    const word = name.trim();
    if (!word) return "Give the site a name.";
    if (word.length > 100) return "A name has at most 100 characters.";
    if (/[\p{C}\p{Zl}\p{Zp}]/u.test(word)) return "A name has printable characters only.";
    const taken = siteNames(design).some((other, k) => k !== index && other === word);
    return taken ? `Another site has the name “${word}”.` : null;
}

/**
 * The design with keys of its cell changed; undefined takes a key out.
 * @type {(design: Design, patch: Partial<Cell>) => Design}
 */
export function setCell(design, patch) {
    const entries = Object.entries({ ...design.cell, ...patch }).filter(([, value]) => value !== undefined);
    return { ...design, cell: /** @type {Cell} */ (Object.fromEntries(entries)) };
}

/**
 * The design in other units; with `convert` its numbers change and its size stays, else the other way round.
 * @type {(design: Design, units: Unit, convert: boolean) => Design}
 */
export function setUnits(design, units, convert) {
    const from = design.units ?? "mm";
    if (from === units) return design;
    const factor = MILLIMETRES[from] / MILLIMETRES[units];
    const renamed = { ...design, units };
    return convert
        ? {
              ...renamed,
              cell: largerCell(design.cell, factor),
              site: design.site.map(larger(factor)),
              ...largerStanding(design, factor),
          }
        : renamed;
}

/**
 * The design with keys of its solid changed; undefined takes a key out.
 * @type {(design: Design, patch: Partial<Standing>) => Design}
 */
export function setSolid(design, patch) {
    const entries = Object.entries({ ...design.solid, ...patch }).filter(([, value]) => value !== undefined);
    return { ...design, solid: /** @type {Standing} */ (Object.fromEntries(entries)) };
}

/**
 * A flat design as one that stands, half as high as its cell is wide, whose strokes turn about a point.
 * @type {(design: Design, turn: number, about: Point) => Design}
 */
export const standing = (design, turn, about) =>
    setSolid(design, { height: Number((design.cell.a / 2).toPrecision(3)), turn, about });

/** The design without what stands above its drawing. @type {(design: Design) => Design} */
export function flat(design) {
    const { solid: _, key: __, ...drawing } = design;
    return drawing;
}

/** A cell whose sides are times a factor. @type {(cell: Cell, factor: number) => Cell} */
function largerCell(cell, factor) {
    const b = cell.b === undefined ? {} : { b: tidyProduct(cell.b, factor) };
    return { ...cell, a: tidyProduct(cell.a, factor), ...b };
}

/** What makes a site larger by a factor. @type {(factor: number) => (site: Site) => Site} */
const larger = (factor) => (site) => {
    /** @type {Site} */
    const placed = {
        ...largerShift(site, factor),
        strokes: site.strokes.map((stroke) => largerStroke(stroke, factor)),
    };
    const art = typeof site.art === "object" ? { art: largerShift(site.art, factor) } : {};
    return { ...placed, ...art, ...largerKey(site, "tolerance", factor) };
};

/**
 * A stroke larger by a factor. Path data become so by the stroke's `scale`; drawings in files have a size of their own.
 * @type {(stroke: Stroke, factor: number) => Stroke}
 */
function largerStroke(stroke, factor) {
    const large = (/** @type {Point} */ point) => largerPoint(point, factor);
    return {
        ...mapPoints(largerShift(stroke, factor), large),
        ...(stroke.tangents ? { tangents: stroke.tangents.map(large) } : {}),
        ...largerKey(stroke, "radius", factor),
        ...(stroke.path === undefined ? {} : { scale: tidyProduct(stroke.scale ?? 1, factor) }),
    };
}

/**
 * What stands above a drawing, larger by a factor; nothing where it is flat.
 * @type {(design: Design, factor: number) => Pick<Design, "solid" | "key">}
 */
function largerStanding({ solid, key }, factor) {
    const points = /** @type {const} */ (["shift", "about"]).flatMap((name) => {
        const at = solid?.[name];
        return at ? [[name, largerPoint(at, factor)]] : [];
    });
    return {
        ...(solid ? { solid: { ...solid, ...largerKey(solid, "height", factor), ...Object.fromEntries(points) } } : {}),
        ...(key ? { key: key.map((one) => largerDrawing(one, factor)) } : {}),
    };
}

/** A key drawing larger by a factor. @type {(drawing: KeyDrawing, factor: number) => KeyDrawing} */
function largerDrawing(drawing, factor) {
    const strokes = drawing.strokes.map((stroke) => largerStroke(stroke, factor));
    return { ...drawing, ...largerKey(drawing, "z", factor), strokes };
}

/** A point times a factor. @type {(point: Point, factor: number) => Point} */
const largerPoint = ([x, y], factor) => [tidyProduct(x, factor), tidyProduct(y, factor)];

/**
 * What is placed, moved by a vector that is times a factor.
 * @template {Placed} T
 * @param {T} table
 * @param {number} factor
 * @returns {T}
 */
function largerShift(table, factor) {
    return table.translate ? { ...table, translate: largerPoint(table.translate, factor) } : table;
}

/**
 * A key of a table with its number times a factor; nothing where it is not there.
 * @template {string} K
 * @param {{[key in K]?: number}} table
 * @param {K} key
 * @param {number} factor
 * @returns {{[key in K]?: number}}
 */
function largerKey(table, key, factor) {
    const value = table[key];
    return /** @type {{[key in K]?: number}} */ (value === undefined ? {} : { [key]: tidyProduct(value, factor) });
}
