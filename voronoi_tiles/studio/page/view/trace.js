// @ts-check
// The picture to trace, over the coloured tiles.

/**
 * Draw the picture, if there is one. The context's transform is another one afterwards.
 * @param {CanvasRenderingContext2D} context
 * @param {import("./camera.js").Camera} camera
 * @param {import("../store.js").Trace} trace
 */
export function drawTrace(context, camera, { image, at, width, turn, opacity }) {
    if (!image || !at) {
        return;
    }
    const wide = width * camera.scale;
    const high = (wide * image.height) / image.width;
    context.setTransform(camera.ratio, 0, 0, camera.ratio, 0, 0);
    context.translate(...camera.toScreen(at));
    context.rotate((-turn * Math.PI) / 180);
    context.globalAlpha = opacity;
    context.drawImage(image, -wide / 2, -high / 2, wide, high);
    context.globalAlpha = 1;
}
