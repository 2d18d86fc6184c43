/** JSCAD's @jscad/dxf-deserializer: its lines and outlines. */

import deserializer from "@jscad/dxf-deserializer";
import { answer, text } from "./answer.mjs";

const read = [deserializer.deserialize({ output: "geometry" }, text)].flat(9);
const contours = read.map(({ points, isClosed }) => ({
    points: points.map(([x, y]) => [x, y]),
    closed: Boolean(isClosed),
}));
answer("@jscad/dxf-deserializer", contours, { entities: read.flatMap(({ points }) => points.map(() => "point")) });
