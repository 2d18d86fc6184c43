// @ts-check
// What dialogs send to the server, and the files that come back.

import { make } from "./elements.js";

/** @param {Blob} blob @param {string} name */
export function download(blob, name) {
    const address = URL.createObjectURL(blob);
    make("a", { href: address, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

/**
 * Post to the server; what it refuses is an error for people.
 * @param {string} path
 * @param {BodyInit} body
 * @param {{type?: string, signal?: AbortSignal}} [more] `signal` gives it up
 */
export async function post(path, body, { type = "application/json", signal } = {}) {
    const answer = await fetch(path, { method: "POST", headers: { "Content-Type": type }, body, signal });
    if (!answer.ok) {
        const error = await answer.json().catch(() => ({ message: `The server says ${answer.status}`, remedy: "" }));
        throw Object.assign(new Error(`${error.message.replace(/\.?$/, ".")} ${error.remedy ?? ""}`.trim()), { error });
    }
    return answer;
}

/** @param {Response} answer @param {string} other */
export function nameOf(answer, other) {
    const name = answer.headers.get("Content-Disposition")?.match(/filename\*=utf-8''([^;]+)/)?.[1];
    return name ? decodeURIComponent(name) : other;
}
