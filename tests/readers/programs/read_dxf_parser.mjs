/** dxf-parser: vertices and bulges of polylines, control points of splines, as they stand in the file. */

import DxfParser from "dxf-parser";
import { answer, sampled, text } from "./answer.mjs";

/** Points along an arc of a polyline: `bulge` is the tangent of a quarter of its sweep. */
function arc(start, end, bulge) {
    const [dx, dy] = [end[0] - start[0], end[1] - start[1]];
    const high = (1 / bulge - bulge) / 4;
    const centre = [(start[0] + end[0]) / 2 - high * dy, (start[1] + end[1]) / 2 + high * dx];
    const [x, y] = [start[0] - centre[0], start[1] - centre[1]];
    return sampled((t) => {
        const turn = 4 * Math.atan(bulge) * t;
        const [cos, sin] = [Math.cos(turn), Math.sin(turn)];
        return [centre[0] + x * cos - y * sin, centre[1] + x * sin + y * cos];
    });
}

/** Points along a B-spline of degree 3, whose pieces are found by its knots: de Boor's rule. */
function spline({ controlPoints, knotValues: knots, degreeOfSplineCurve: degree }) {
    const spans = knots.flatMap((knot, k) => (knot < knots[k + 1] ? [k] : []));
    const at = (span, u) => {
        const d = Array.from({ length: degree + 1 }, (_, j) => {
            const { x, y } = controlPoints[j + span - degree];
            return [x, y];
        });
        for (let r = 1; r <= degree; r++)
            for (let j = degree; j >= r; j--) {
                const [low, high] = [knots[j + span - degree], knots[j + 1 + span - r]];
                const share = (u - low) / (high - low);
                d[j] = d[j].map((value, axis) => (1 - share) * d[j - 1][axis] + share * value);
            }
        return d[degree];
    };
    return spans.flatMap((k) => sampled((t) => at(k, knots[k] + t * (knots[k + 1] - knots[k]))));
}

const { entities, header } = new DxfParser().parseSync(text);
const scale = { 1: 25.4, 4: 1 }[header.$INSUNITS] ?? 1;
const contours = entities.map((entity) => {
    if (entity.type === "SPLINE") return { points: spline(entity), closed: Boolean(entity.closed) };
    const corners = entity.vertices.map(({ x, y }) => [x, y]);
    const next = entity.shape ? [...corners.slice(1), corners[0]] : corners.slice(1);
    const along = next.flatMap((end, k) => {
        const { bulge } = entity.vertices[k];
        return bulge ? arc(corners[k], end, bulge) : [end];
    });
    return { points: [corners[0], ...along], closed: Boolean(entity.shape) };
});
answer("dxf-parser", contours, { scale, entities: entities.map(({ type }) => type) });
