// @ts-check
// Solids as the server sends them: a frame of a message and the meshes of its pieces; and the way they are looked at.

/** @typedef {readonly [number, number, number]} Vector */
/**
 * @typedef {object} Mesh
 * @property {Float32Array} positions of vertices, from the centre of all; millimetres
 * @property {Uint32Array} triangles indices of their vertices
 * @property {Int8Array} normals at the corners of the triangles, times 127, each with a zero behind it
 * @typedef {object} PieceKeys
 * @property {string} site
 * @property {number} colour
 * @property {Vector} middle of its box, from the centre
 * @typedef {Mesh & PieceKeys} Piece
 * @typedef {object} Solid
 * @property {number} rev
 * @property {boolean} coarse whether an exact one follows
 * @property {string[]} colours "#rrggbb"
 * @property {Piece[]} pieces the tile first, where it is one with its neighbours
 * @property {{site: string, size: Vector, volume: number, triangles: number}[]} tiles one of each site; millimetres
 * @property {number} count of the pieces that there are
 * @property {string} proved
 * @property {string[]} notes
 * @property {number} ms
 */

/** What a corner takes in the buffer that is drawn: three numbers of four bytes, four of one; bytes. */
export const CORNER = 16;

/**
 * The message that is in a frame; the pieces of a solid have their meshes.
 * @param {ArrayBuffer} frame
 * @returns {any}
 */
export function unpacked(frame) {
    const head = new DataView(frame).getUint32(0);
    const message = JSON.parse(new TextDecoder().decode(new Uint8Array(frame, 8, head)));
    const body = frame.slice(8 + head); // numbers of four bytes begin where four divides
    let at = 0;
    for (const piece of message.pieces) {
        const { vertices, triangles } = piece;
        piece.positions = new Float32Array(body, at, 3 * vertices);
        piece.triangles = new Uint32Array(body, (at += 12 * vertices), 3 * triangles);
        piece.normals = new Int8Array(body, (at += 12 * triangles), 12 * triangles);
        at += 12 * triangles;
    }
    return message;
}

/**
 * The corners of a mesh's triangles as they are drawn, CORNER bytes each: where one is, and its normal.
 * @type {(mesh: Mesh) => ArrayBuffer}
 */
export function cornersOf({ positions, triangles, normals }) {
    const buffer = new ArrayBuffer(CORNER * triangles.length);
    const places = new Float32Array(buffer);
    const four = new Int32Array(normals.buffer, normals.byteOffset, triangles.length);
    const directions = new Int32Array(buffer);
    for (let k = 0; k < triangles.length; k++) {
        const [at, from] = [4 * k, 3 * triangles[k]];
        places[at] = positions[from];
        places[at + 1] = positions[from + 1];
        places[at + 2] = positions[from + 2];
        directions[at + 3] = four[k];
    }
    return buffer;
}

/**
 * How far from the centre vertices are at most where pieces are pulled apart: level, and up or down.
 * @type {(pieces: readonly Piece[], apart: number) => [number, number]}
 */
export function reachOf(pieces, apart) {
    let [level, up] = [0, 0];
    for (const piece of pieces) {
        const { positions } = piece;
        const [x, y] = pulled(piece, apart);
        for (let k = 0; k < positions.length; k += 3) {
            level = Math.max(level, (positions[k] + x) ** 2 + (positions[k + 1] + y) ** 2);
            up = Math.max(up, Math.abs(positions[k + 2]));
        }
    }
    return [Math.sqrt(level), up];
}

/** How far a piece is moved that is pulled away from the centre by a share of its distance. @type {(piece: Pick<Piece, "middle">, apart: number) => Vector} */
export const pulled = ({ middle: [x, y] }, apart) => [x * apart, y * apart, 0];

/**
 * How steeply one looks down on it, and from which side, at first; degrees, as the program's own pictures.
 * @type {Readonly<{turn: number, tilt: number}>}
 */
export const FIRST_LOOK = Object.freeze({ turn: -24, tilt: 42 });

/** The way solids are looked at: from `tilt` degrees above the horizon, turned by `turn` about the vertical. */
export class Look {
    turn = FIRST_LOOK.turn;
    tilt = FIRST_LOOK.tilt;
    /** pixels of CSS a millimetre */
    scale = 1;
    /** where the centre is, from the middle of the window, y up; pixels of CSS @type {[number, number]} */
    pan = [0, 0];

    /** The directions to the right, up and toward the eye. @returns {[Vector, Vector, Vector]} */
    get axes() {
        const [turn, tilt] = [this.turn, this.tilt].map((degrees) => (degrees * Math.PI) / 180);
        const [c, s, ct, st] = [Math.cos(turn), Math.sin(turn), Math.cos(tilt), Math.sin(tilt)];
        return [
            [c, s, 0],
            [-s * st, c * st, ct],
            [s * ct, -c * ct, st],
        ];
    }

    /** Turn it as a ball under the pointer. @param {number} right degrees @param {number} down degrees */
    roll(right, down) {
        this.turn = (this.turn - right) % 360;
        this.tilt = Math.max(-90, Math.min(90, this.tilt + down));
    }

    /** @param {number} factor @param {readonly [number, number]} at what stays, from the middle of the window, y up */
    zoomAt(factor, at) {
        const scale = Math.max(0.01, Math.min(1000, this.scale * factor));
        const by = scale / this.scale;
        this.pan = [at[0] - (at[0] - this.pan[0]) * by, at[1] - (at[1] - this.pan[1]) * by];
        this.scale = scale;
    }
}
