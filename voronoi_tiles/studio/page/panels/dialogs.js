// @ts-check
// The dialogs: export, gallery, help, share, opening files, and what to do when a file has changed or was left unsaved.

import { HELP } from "../tools/keys.js";
import { paste } from "../clipboard.js";
import { field, make } from "./elements.js";

/**
 * @typedef {object} Context
 * @property {import("../store.js").Store} store
 * @property {import("../link.js").Link} link
 * @property {import("../view/stage.js").Stage} stage
 */

/** @param {Blob} blob @param {string} name */
function download(blob, name) {
  const address = URL.createObjectURL(blob);
  make("a", { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

/**
 * Post to the server; what it refuses is an error for people.
 * @param {string} path
 * @param {BodyInit} body
 * @param {string} [type]
 */
async function post(path, body, type = "application/json") {
  const answer = await fetch(path, { method: "POST", headers: { "Content-Type": type }, body });
  if (!answer.ok) {
    const error = await answer.json().catch(() => ({ message: `The server says ${answer.status}`, remedy: "" }));
    throw Object.assign(new Error(`${error.message.replace(/\.?$/, ".")} ${error.remedy ?? ""}`.trim()), { error });
  }
  return answer;
}

/** @param {Response} answer @param {string} other */
function nameOf(answer, other) {
  return answer.headers.get("Content-Disposition")?.match(/filename="([^"]+)"/)?.[1] ?? other;
}

/**
 * The dialogs of the page, each a function that opens it.
 * @param {HTMLElement} home
 * @param {Context} context
 */
export function dialogs(home, { store, link, stage }) {
  /**
   * @param {string} title
   * @param {Node[]} content
   * @param {{label: string, first?: boolean, run?: () => unknown}[]} actions the last closes without doing anything
   */
  const open = (title, content, actions) => {
    const said = make("p", { class: "error", role: "alert" });
    const buttons = actions.map(({ label, first, run }) =>
      make(
        "button",
        {
          type: "button",
          class: first ? "first" : "",
          onclick: async () => {
            try {
              await run?.();
              box.close();
            } catch (error) {
              said.textContent = error instanceof Error ? error.message : String(error);
            }
          },
        },
        label,
      ),
    );
    const heading = make("h2", { id: "dialog-title" }, title);
    const box = make("dialog", { "aria-labelledby": "dialog-title", onclose: () => box.remove() }, heading, ...content, said, make("footer", {}, ...buttons));
    home.replaceChildren(box);
    box.showModal();
    return { box, said };
  };

  const close = { label: "Close" };
  const cancel = { label: "Cancel" };

  /** @param {any} design @param {string} [note] */
  const begin = (design, note) => {
    store.edit("open", () => design, { selection: { strokes: [], nodes: [] } });
    store.set({ site: 0 });
    stage.fit();
    if (note) {
      store.set({ trouble: { message: note, remedy: "" } });
    }
  };

  /** @param {File} file */
  const take = async (file) => {
    const { design } = store.state;
    const units = encodeURIComponent(design.units ?? "mm");
    const answer = await (await post(`drop?name=${encodeURIComponent(file.name)}&units=${units}`, file, "application/octet-stream")).json();
    if (answer.design) {
      begin(answer.design);
      store.set({ job: answer.job ?? {} });
    } else {
      paste(store, answer.strokes, 0);
    }
    if (answer.notes?.length) {
      store.set({ trouble: { message: answer.notes.join(" "), remedy: "" } });
    }
  };

  /** @param {File | undefined} file */
  const tryTake = (file) => {
    if (file) {
      take(file).catch((error) => store.set({ trouble: { message: error.message, remedy: "" } }));
    }
  };
  document.addEventListener("dragover", (event) => event.preventDefault());
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    tryTake(event.dataTransfer?.files[0]);
  });
  document.addEventListener("studio-drop", (event) => tryTake(/** @type {CustomEvent} */ (event).detail));

  return {
    export() {
      const { tables, job, file } = store.state;
      const stem = file.replace(/\.[^.]*$/, "") || "tiles";
      const name = make("input", { type: "text", ".value": stem, autocomplete: "off" });
      const format = make("select", {}, ...tables.formats.map((/** @type {string} */ one) => make("option", {}, one)));
      const what = Object.keys(job).length
        ? Object.entries(job).map(([key, value]) => `${key} ${Array.isArray(value) ? value.join(" x ") : value}`).join(", ")
        : "no options: the exact tiles, one of each";
      open(
        "Export",
        [field("Format", format), field("Name", name), make("p", { class: "note" }, `The job: ${what}.`)],
        [
          {
            label: "Download",
            first: true,
            run: async () => {
              const answer = await post("export", JSON.stringify({ design: store.settled, job: { ...store.state.job, format: format.value }, name: name.value }));
              download(await answer.blob(), nameOf(answer, `${name.value}.${format.value}`));
            },
          },
          cancel,
        ],
      );
    },

    coupon() {
      const thickness = make("input", { type: "text", ".value": "3mm" });
      open(
        "A test piece that shows the kerf",
        [make("p", {}, "Cut it once in your material: how well its slots fit says how wide your laser cuts."), field("Thickness of the material", thickness)],
        [
          {
            label: "Download",
            first: true,
            run: async () => {
              const answer = await post("coupon", JSON.stringify({ thickness: thickness.value }));
              download(await answer.blob(), nameOf(answer, "coupon.svg"));
            },
          },
          cancel,
        ],
      );
    },

    async gallery() {
      const { box } = open("Begin with an example", [make("p", { class: "note" }, "What is drawn now can be taken back with undo.")], [close]);
      const list = make("ul", { class: "gallery" });
      box.querySelector("footer")?.before(list);
      const examples = await (await fetch("examples.json")).json();
      for (const example of examples) {
        list.append(
          make(
            "li",
            {},
            make(
              "button",
              {
                type: "button",
                onclick: () => {
                  begin(example.design);
                  box.close();
                },
              },
              make("strong", {}, example.group),
              ` ${example.title ?? example.name}`,
            ),
          ),
        );
      }
    },

    open() {
      const input = make("input", { type: "file", accept: ".svg,.svgz,.dxf,.pdf,.lbrn2,.toml,.json" });
      open(
        "Open",
        [
          make("p", {}, "An SVG or DXF drawing becomes strokes of the site in hand. A file that was exported from here opens as the design and the job that it was made of."),
          field("File", input),
        ],
        [{ label: "Open", first: true, run: () => input.files?.[0] && take(input.files[0]) }, cancel],
      );
    },

    share() {
      const text = JSON.stringify(store.settled);
      const code = btoa(String.fromCharCode(...new TextEncoder().encode(text))).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
      const address = make("textarea", { readonly: true, rows: 4, "aria-label": "Link", ".value": `${location.origin}/#design=${code}` });
      open(
        "Share",
        [make("p", {}, "The link holds the whole design after its #, which browsers do not send. Who opens it needs a studio that runs at this address; the file suits everybody."), address],
        [
          { label: "Copy the link", first: true, run: () => navigator.clipboard.writeText(address.value) },
          { label: "Download the file", run: () => this.saveAs() },
          close,
        ],
      );
      address.select();
    },

    async saveAs() {
      const answer = await post("toml", JSON.stringify({ design: store.settled }));
      download(await answer.blob(), nameOf(answer, store.state.file || "design.toml"));
    },

    help() {
      const columns = HELP.map(({ title, rows }) =>
        make("section", {}, make("h3", {}, title), make("dl", { class: "keys" }, ...rows.flatMap(({ keys, does }) => [make("dt", {}, make("kbd", {}, keys)), make("dd", {}, does)]))),
      );
      open("Keys", [make("div", { class: "help" }, ...columns)], [close]);
    },

    /** @param {{design: any, at: string}} recovery */
    recover({ design, at }) {
      open(
        "Something was not saved",
        [make("p", {}, `A copy of what was drawn last, at ${new Date(at).toLocaleString()}, is newer than the file.`)],
        [
          { label: "Take the copy", first: true, run: () => begin(design) },
          { label: "Stay with the file" },
        ],
      );
    },

    /** @param {{design: any}} message */
    conflict({ design }) {
      open(
        "The file has changed",
        [make("p", {}, "Somebody else has written the file since it was opened. What is there now, or what is drawn here?")],
        [
          {
            label: "Keep mine",
            first: true,
            run: () => link.send({ type: "save", rev: store.state.revision, design: store.settled, over: true }),
          },
          ...(design ? [{ label: "Take theirs", run: () => begin(design) }] : []),
          cancel,
        ],
      );
    },

    /** @param {{design: any, note?: string}} message */
    changed({ design, note }) {
      if (design && store.state.saved) {
        begin(design);
        store.set({ saved: true });
        return;
      }
      open(
        "The file has changed outside",
        [make("p", {}, note ?? "Another program has written the design's file.")],
        [...(design ? [{ label: "Take theirs", first: true, run: () => begin(design) }] : []), { label: "Keep mine" }],
      );
    },
  };
}
