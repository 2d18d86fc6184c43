// @ts-check
/** What Paper.js makes of an SVG text; its own y goes down. */

import paper from "paper-jsdom";
import { sampled } from "./answer.mjs";

/**
 * The contours of an SVG text in its user units.
 * @param {string} svg
 * @returns {{ points: [number, number][], closed: boolean }[]}
 */
export function paperContours(svg) {
    paper.setup(new paper.Size(1000, 1000));
    const paths = paper.project.importSVG(svg).getItems({ class: paper.Path });
    return paths
        .filter((path) => !path.clipMask)
        .map((path) => ({
            points: path.curves.flatMap((curve) => [
                [curve.point1.x, curve.point1.y],
                ...sampled((t) => {
                    const { x, y } = curve.getPointAtTime(t);
                    return [x, y];
                }),
            ]),
            closed: path.closed,
        }));
}
