/** Paper.js: `project.importSVG`, in the user units of the page. */

import { answer, text, userUnit } from "./answer.mjs";
import { paperContours } from "./paper_contours.mjs";

answer("paper", paperContours(text), { scale: userUnit(text), down: true });
