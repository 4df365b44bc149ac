// A live run: frames come in a stream, commands go out one after the other.
import { readBundle } from "./bundle.js";
import { frameFloats, readFrame } from "./frame.js";

const kinds = { frame: 1, status: 2 };
const headBytes = 8;

export class Live {
  constructor(token, { onFrame, onStatus, onEnd }) {
    this.headers = { "X-Tegotae-Token": token };
    Object.assign(this, { onFrame, onStatus, onEnd });
    this.pending = new Map(); // the newest command of each kind that still waits
    this.sending = false;
  }

  async get(what) {
    const answer = await fetch(what, { headers: this.headers }).catch(() => {
      throw new Error("The program does not answer.");
    });
    if (!answer.ok) throw new Error((await answer.text()).trim());
    return answer;
  }
  async scene() {
    return readBundle(await (await this.get("scene")).arrayBuffer());
  }
  // What changes of the scene when it does.
  async parts() {
    return (await this.get("parts")).json();
  }
  // The report on a recording, or on a run by `script`; a blob.
  async review(script = null) {
    const answer = await fetch("review", script === null ? { headers: this.headers } : { method: "POST", headers: this.headers, body: script }).catch(() => {
      throw new Error("The program does not answer.");
    });
    if (!answer.ok) throw new Error((await answer.text()).trim());
    return answer.blob();
  }

  // Until the server ends it.
  async watch() {
    try {
      const answer = await fetch("stream", { headers: this.headers });
      if (!answer.ok) throw new Error((await answer.text()).trim());
      const reader = answer.body.getReader();
      let rest = new Uint8Array(0);
      for (;;) {
        const { done, value } = await reader.read();
        if (done) break;
        const bytes = new Uint8Array(rest.length + value.length);
        bytes.set(rest);
        bytes.set(value, rest.length);
        rest = this.take(bytes);
      }
      this.onEnd("The program has ended.");
    } catch (error) {
      this.onEnd(error instanceof TypeError ? "The program has ended." : error.message);
    }
  }

  // Handles the whole messages at the beginning of `bytes`, of frames only the last; returns what is left.
  take(bytes) {
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
    let at = 0;
    let newest = null;
    while (bytes.length - at >= headBytes) {
      const kind = view.getUint32(at, true);
      const end = at + headBytes + view.getUint32(at + 4, true);
      if (end > bytes.length) break;
      const body = bytes.slice(at + headBytes, end);
      if (kind === kinds.frame) newest = new Float32Array(body.buffer);
      if (kind === kinds.status) this.onStatus(JSON.parse(new TextDecoder().decode(body)));
      at = end;
    }
    if (newest) this.onFrame(readFrame(newest, newest.subarray(frameFloats)));
    return bytes.slice(at);
  }

  // A command replaces one of its kind that has not gone yet: of a drag only the newest place counts.
  send(command) {
    this.pending.set(command.do, command);
    if (!this.sending) this.flush();
  }

  // Changes the scene; throws what the program says against it.
  async edit(command) {
    const answer = await this.post(command).catch(() => {
      throw new Error("The program does not answer.");
    });
    if (!answer.ok) throw new Error((await answer.text()).trim());
  }

  post(command) {
    return fetch("command", { method: "POST", headers: this.headers, body: JSON.stringify(command) });
  }

  async flush() {
    this.sending = true;
    while (this.pending.size > 0) {
      const [kind, command] = this.pending.entries().next().value;
      this.pending.delete(kind);
      try {
        const answer = await this.post(command);
        if (!answer.ok) this.onStatus({ message: (await answer.text()).trim() });
      } catch {
        break; // the stream says that the program has ended
      }
    }
    this.sending = false;
  }
}
