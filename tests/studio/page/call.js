/** Calls a function of the model for each list of arguments in standard input, as JSON, and writes what it gives. */

import { readFileSync } from "node:fs";

const { module, name, calls } = JSON.parse(readFileSync(0, "utf8"));
const { [name]: called } = await import(
    new URL(`../../../voronoi_tiles/studio/page/model/${module}`, import.meta.url).href
);
process.stdout.write(JSON.stringify(calls.map((values) => called(...values))));
