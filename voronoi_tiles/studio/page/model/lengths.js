// @ts-check
/** Lengths as people write and read them: sums and products of numbers with units. */

/** @import { Unit } from "./design.js" */

/** Millimetres in each unit. @type {Readonly<Record<Unit, number>>} */
export const MILLIMETRES = Object.freeze({ mm: 1, cm: 10, in: 25.4 });

/** The ways to write the units. @type {ReadonlyMap<string, Unit>} */
const WORDS = new Map([
    ["mm", "mm"],
    ["cm", "cm"],
    ["in", "in"],
    ["inch", "in"],
    ["inches", "in"],
    ['"', "in"],
    ["″", "in"],
]);

const REMEDY = "Write a length such as 12.5mm, 1/4in or 60 - 2*3.5.";

const TOKEN = /\s*(?:(\d+(?:[.,]\d*)?(?:e[+-]?\d+)?|[.,]\d+(?:e[+-]?\d+)?)|([a-z]+|["″])|([-+*/()−×·÷]))/iy;

/** Signs that stand for others. @type {Readonly<Record<string, string>>} */
const SIGNS = { "−": "-", "×": "*", "·": "*", "÷": "/" };

/**
 * A quantity: how much, and whether it is a length (in millimetres) or a number.
 * @typedef {{value: number, isLength: boolean}} Quantity
 */

/** @typedef {{number?: number, word?: string, sign?: string}} Token */
/**
 * @typedef {{tokens: Token[], at: number, size: number}} Reader the tokens, how many are read, and the unit in
 * millimetres
 */

/**
 * The length that a text says, in a unit, which is also that of numbers without one.
 *
 * Sums, differences, products, quotients and brackets are taken; a comma is a point. Throws an Error whose message
 * tells what is wrong and what to write.
 * @type {(text: string, unit: string) => number}
 */
export function evaluate(text, unit) {
    const reader = { tokens: tokensOf(text), at: 0, size: MILLIMETRES[WORDS.get(unit) ?? "mm"] };
    if (!reader.tokens.length) throw new Error(REMEDY);
    const { value, isLength } = sum(reader);
    const rest = reader.tokens[reader.at];
    if (rest) throw new Error(`“${text.trim()}” does not go on with ${named(rest)}. ${REMEDY}`);
    const length = isLength ? value / reader.size : value;
    if (!Number.isFinite(length)) throw new Error(`“${text.trim()}” is no number. ${REMEDY}`);
    return Number(length.toPrecision(15));
}

/** A sum of products; a number beside a length is one in the unit. @type {(from: Reader) => Quantity} */
function sum(from) {
    let left = product(from);
    for (let sign = taken(from, "+-"); sign; sign = taken(from, "+-")) {
        const right = product(from);
        const isLength = left.isLength || right.isLength;
        const [p, q] = [left, right].map((side) => side.value * (isLength && !side.isLength ? from.size : 1));
        left = { value: sign === "+" ? p + q : p - q, isLength };
    }
    return left;
}

/**
 * A product of factors, of which one may be a length; a quotient's unit follows it.
 * @type {(from: Reader) => Quantity}
 */
function product(from) {
    let left = withUnit(from, factor(from));
    for (let sign = taken(from, "*/"); sign; sign = taken(from, "*/")) {
        if (sign === "*") {
            const right = withUnit(from, factor(from));
            if (left.isLength && right.isLength) throw new Error(`Two lengths multiplied are no length. ${REMEDY}`);
            left = { value: left.value * right.value, isLength: left.isLength || right.isLength };
        } else {
            const right = factor(from);
            if (right.isLength) throw new Error(`What is divided by a length is no length. ${REMEDY}`);
            left = withUnit(from, { value: left.value / right.value, isLength: left.isLength });
        }
    }
    return left;
}

/** A signed number, or a sum in brackets, without the unit that may follow. @type {(from: Reader) => Quantity} */
function factor(from) {
    const sign = taken(from, "+-");
    if (sign) {
        const { value, isLength } = factor(from);
        return { value: sign === "-" ? -value : value, isLength };
    }
    if (taken(from, "(")) {
        const inner = sum(from);
        if (!taken(from, ")")) throw new Error(`A bracket is not closed. ${REMEDY}`);
        return inner;
    }
    const token = from.tokens[from.at];
    if (token?.number === undefined)
        throw new Error(`A number is missing${token ? ` before ${named(token)}` : ""}. ${REMEDY}`);
    from.at++;
    return { value: token.number, isLength: false };
}

/**
 * A quantity with the unit that follows it, if one does: 1/4in is a quarter of an inch.
 * @type {(from: Reader, quantity: Quantity) => Quantity}
 */
function withUnit(from, quantity) {
    const word = from.tokens[from.at]?.word;
    if (word === undefined) return quantity;
    const unit = WORDS.get(word);
    if (!unit) throw new Error(`There is no unit “${word}” here: use mm, cm or in. ${REMEDY}`);
    if (quantity.isLength) throw new Error(`A length has one unit. ${REMEDY}`);
    from.at++;
    return { value: quantity.value * MILLIMETRES[unit], isLength: true };
}

/** The sign that comes next, taken, if it is one of some. @type {(from: Reader, signs: string) => string} */
function taken(from, signs) {
    const sign = from.tokens[from.at]?.sign ?? "";
    if (!sign || !signs.includes(sign)) return "";
    from.at++;
    return sign;
}

/** What a token is called in messages. @type {(token: Token) => string} */
const named = ({ number, word, sign }) => `“${number ?? word ?? sign}”`;

/** The numbers, words and signs of a text. @type {(text: string) => Token[]} */
function tokensOf(text) {
    /** @type {Token[]} */
    const tokens = [];
    const end = text.trimEnd().length;
    TOKEN.lastIndex = 0;
    while (TOKEN.lastIndex < end) {
        const at = TOKEN.lastIndex;
        const match = TOKEN.exec(text);
        if (!match) throw new Error(`“${text.slice(at).trim()[0]}” has no meaning in a length. ${REMEDY}`);
        const [, number, word, sign] = match;
        if (number) tokens.push({ number: Number(number.replace(",", ".")) });
        else tokens.push(word ? { word: word.toLowerCase() } : { sign: SIGNS[sign] ?? sign });
    }
    return tokens;
}

/**
 * A length as it is shown: a number in a unit, to a thousandth of a millimetre or finer.
 * @type {(value: number, unit: string) => string}
 */
export function shown(value, unit) {
    const digits = WORDS.get(unit) === "mm" ? 3 : 4;
    const text = value.toFixed(digits).replace(/\.?0+$/, "");
    return text === "-0" ? "0" : text;
}
