/** JSCAD's @jscad/svg-deserializer, with the target "path"; its y goes up, its unit is the millimetre. */

import deserializer from "@jscad/svg-deserializer";
import { answer, text } from "./answer.mjs";

const read = deserializer.deserialize({ output: "geometry", target: "path", pathSelfClosed: "trim" }, text);
const contours = read.map(({ points, isClosed }) => ({
    points: points.map(([x, y]) => [x, y]),
    closed: isClosed,
}));
answer("@jscad/svg-deserializer", contours, { entities: read.flatMap(({ points }) => points.map(() => "point")) });
