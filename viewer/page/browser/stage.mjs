// Real irdm-server and irdm-bridge on a scene of the test's own.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { until } from "./browser.mjs";

const { IRDM_SERVER, IRDM_BRIDGE, IRDM_MODEL } = process.env;

/** A folder with a scene and a script, and what was started on it; all of it ends with the test. */
export class Stage {
  /** @param scene tables, @param object keys of the only object */
  constructor(context, scene = "", object = "") {
    this.folder = mkdtempSync(path.join(tmpdir(), "irdm-browser-"));
    this.children = [];
    this.scene(scene, object);
    context.after(() => {
      for (const child of this.children) child.kill("SIGKILL");
      rmSync(this.folder, { recursive: true, force: true });
    });
  }
  scene(tables, object) {
    const model = `[[object]]\nname = "cube"\nmodel = "${IRDM_MODEL}"\n${object}`;
    this.write("scene.toml", `${tables}\n[contact]\ncoupling_stiffness = 2000\n${model}`);
  }
  path(name) {
    return path.join(this.folder, name);
  }
  write(name, text) {
    writeFileSync(this.path(name), text);
  }
  start(program, ...words) {
    const child = spawn(program, words, { stdio: ["ignore", "pipe", "inherit"] });
    child.output = "";
    child.stdout.on("data", (data) => (child.output += data));
    child.ended = new Promise((resolve) => child.on("exit", resolve));
    this.children.push(child);
    return child;
  }
  async server(...words) {
    const child = this.start(IRDM_SERVER, this.path("scene.toml"), ...words);
    await until(() => /on http\S+\n/.test(child.output), "the server listens");
    child.url = /listening on (http\S+)/.exec(child.output)[1];
    child.address = /listening on (\d\S+)/.exec(child.output)[1];
    return child;
  }
  bridge(server) {
    this.write("bridge.toml", '[[device]]\ntype = "virtual"\nscript = "script.csv"\n');
    return this.start(IRDM_BRIDGE, this.path("bridge.toml"), "--server", server.address);
  }
}
