#!/usr/bin/env bash
# Which lines of the decoders the fuzzers' seeds reach (docs/contributing.md), and those that they do not; fails below 95 %.
#   scripts/fuzz.sh --coverage
set -euo pipefail
cd "$(dirname "$0")/.."

needed=95
# What makes something of bytes that come from elsewhere.
decoders=(
  common/wire/frame.cpp common/wire/payload.cpp common/wire/contact_payload.cpp common/wire/secret_key.cpp
  common/wire/datagram_channel.cpp common/wire/frame.cpp common/wire/stream.cpp
  common/wire/connection.cpp common/wire/datagram_socket.cpp
  common/contact/contact_model.cpp common/config/toml_reader.cpp common/blackbox/black_box_file.cpp
  common/model/model_file.cpp common/model/dense_file.cpp common/model/compressed_file.cpp
  common/model/compressed_file.cpp
  server/network/session.cpp scene/scene.cpp trace/trace_layout.cpp trace/trace_rows.cpp trace/trace_layout.hpp
  trace/recording.cpp
  viewer/message_parts.cpp viewer/client_message.cpp viewer/scene_message.cpp
  viewer/state_message.cpp viewer/state_message.cpp viewer/frame_message.cpp
  viewer/request_rules.cpp viewer/connection.cpp
  device_bridge/link/server_session.cpp device_bridge/link/force_receiver.cpp
  device_bridge/bridge_config.cpp device_bridge/stylus_script.cpp
  device_bridge/haply/inverse_messages.cpp device_bridge/haply/inverse_events.cpp
  device_bridge/link/server_session.cpp
  precompute/config.cpp
  precompute/columns/column_file.cpp precompute/compress/dense_input.cpp precompute/mesh/format/*.cpp
  replay/compare/run_reader.cpp
)
lists=build/coverage/tests/fuzz
scripts/build.sh coverage fuzz_replay write_fuzz_seeds
out=out/fuzz/coverage
rm -rf "$out"
mkdir -p "$out"
LLVM_PROFILE_FILE=/dev/null build/coverage/bin/write_fuzz_seeds "$lists/seeds"
for list in "$lists"/*.seeds; do
  parser=$(basename "$list" .seeds)
  mapfile -t seeds <"$list"
  LLVM_PROFILE_FILE=$out/$parser.profraw build/coverage/bin/fuzz_replay "$parser" "${seeds[@]}" >"$out/$parser.log"
done
llvm-profdata-14 merge -o "$out/all.profdata" "$out"/*.profraw
replay=build/coverage/bin/fuzz_replay
llvm-cov-14 show $replay -instr-profile="$out/all.profdata" >"$out/lines"
llvm-cov-14 export $replay -instr-profile="$out/all.profdata" -summary-only |
  node -e '
    const path = require("path");
    const [needed, ...decoders] = process.argv.slice(1);
    const row = (name, { covered, count }) =>
      console.log(`| ${name} | ${covered} of ${count} | ${((100 * covered) / count).toFixed(1)} % |`);
    const all = { covered: 0, count: 0 };
    const found = new Set();
    console.log("| decoder | lines | share |\n| --- | --- | --- |");
    for (const file of JSON.parse(require("fs").readFileSync(0)).data[0].files) {
      const name = path.relative(".", path.resolve(file.filename));
      if (!decoders.includes(name)) continue;
      found.add(name);
      row(name, file.summary.lines);
      all.covered += file.summary.lines.covered;
      all.count += file.summary.lines.count;
    }
    row("all", all);
    const missing = decoders.filter((name) => !found.has(name));
    if (missing.length > 0) console.log(`no lines of ${missing.join(", ")}`);
    process.exitCode = missing.length > 0 || 100 * all.covered < needed * all.count ? 1 : 0;' "$needed" "${decoders[@]}" ||
  { echo "fuzz: below $needed %, or a decoder is not there; line by line: $out/lines" >&2; exit 1; }
echo "fuzz: line by line in $out/lines; those with 0 in the second column are not reached"
