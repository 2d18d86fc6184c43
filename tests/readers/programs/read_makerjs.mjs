/** Maker.js: `importer.fromSVGPathData` of every path; it makes arcs of curves. */

import makerjs from "makerjs";
import { SAMPLES, answer, text, userUnit } from "./answer.mjs";

const paths = [...text.matchAll(/<path[^>]* d="([^"]*)"/g)].map((found) => found[1]);
const entities = [];
const contours = paths.flatMap((data) => {
    const model = makerjs.importer.fromSVGPathData(data);
    makerjs.model.walk(model, { onPath: (walked) => entities.push(walked.pathContext.type) });
    return makerjs.model.findChains(model).map((chain) => ({
        points: chain.links.flatMap(({ walkedPath: { pathContext, offset }, reversed }) => {
            const points = Array.from({ length: SAMPLES + 1 }, (_, k) =>
                makerjs.point.add(makerjs.point.middle(pathContext, k / SAMPLES), offset),
            );
            return reversed ? points.reverse() : points;
        }),
        closed: Boolean(chain.endless),
    }));
});
answer("makerjs", contours, { scale: userUnit(text), entities });
