#!/usr/bin/env bash
# services.sh TREE: systemd finds no fault with the units, and their exposure is at most 2.0; yet they leave the
# programs what they need: real-time priority, locked memory, and to the bridge its devices.
set -euo pipefail
tree=$1
command -v systemd-analyze >/dev/null || { echo "test left out: no systemd-analyze"; exit 0; }

units=$tree/lib/systemd/system
for unit in irdm-server irdm-bridge; do
  # In tenths.
  systemd-analyze security --offline=true --threshold=20 --no-pager "$units/$unit.service" >/dev/null ||
    { systemd-analyze security --offline=true --no-pager "$units/$unit.service" | tail -2 >&2; exit 1; }
  grep -qx 'LimitMEMLOCK=infinity' "$units/$unit.service"
  grep -qx 'RestrictRealtime=no' "$units/$unit.service"
done
# A device fault does not end in a restart, and no force comes before a person wants it.
grep -qx 'RestartPreventExitStatus=3' "$units/irdm-bridge.service"
grep -qx 'ExecStart=irdm-bridge /etc/irdm/bridge.toml --arm button' "$units/irdm-bridge.service"
for secret in irdm.key irdm.token irdm.onlooker-token; do
  grep -qx "LoadCredential=$secret" "$units/irdm-server.service"
done
grep -qx 'LoadCredential=irdm.key' "$units/irdm-bridge.service"
# The priorities of their threads (docs/architecture.md).
grep -qx 'LimitRTPRIO=60' "$units/irdm-server.service"
grep -qx 'LimitRTPRIO=70' "$units/irdm-bridge.service"
grep -qx 'DeviceAllow=char-usb_device rw' "$units/irdm-bridge.service"
