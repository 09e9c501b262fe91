"""Episodes as a dataset of LeRobot, version 2.1: a parquet file an episode, and its description in JSON."""

import json
import os

import numpy

_CHUNK = 1000  # episodes a folder
_PATH = "data/chunk-{episode_chunk:03d}/episode_{episode_index:06d}.parquet"


def _rows(group, names):
    """(n, m) float32: these datasets side by side."""
    parts = [numpy.asarray(group[name], dtype=numpy.float32) for name in names]
    return numpy.concatenate([part.reshape(len(part), -1) for part in parts], axis=1)


def _labels(group, names):
    widths = ((name, int(numpy.prod(group[name].shape[1:]))) for name in names)
    return [f"{name}_{i}" if width > 1 else name for name, width in widths for i in range(width)]


def _statistics(column):
    rows = column.reshape(len(column), -1).astype(float)
    found = {name: getattr(rows, name)(axis=0).tolist() for name in ("min", "max", "mean", "std")}
    return {**found, "count": [len(rows)]}


def _write_lines(path, lines):
    with open(path, "w", encoding="utf-8") as file:
        file.writelines(json.dumps(line) + "\n" for line in lines)


def to_lerobot(episodes, folder, task, fps, observations=None):
    """Makes a dataset for LeRobot from a file of Episodes. Needs h5py and pyarrow (Debian 12 has none).

    folder: new or empty. task: what is done, in words. fps: actions a second. observations: names of those that make
    `observation.state`, in this order; None: all, by name. Actions, rewards, ends: `action`, `next.reward`, `next.done`.
    Raises FileExistsError where the folder is not empty, KeyError for an observation that is not there.
    """
    import h5py
    import pyarrow
    from pyarrow import parquet

    os.makedirs(folder, exist_ok=True)
    if os.listdir(folder):
        raise FileExistsError(f"{folder}: is not empty; choose another folder")
    os.mkdir(os.path.join(folder, "meta"))
    lengths, statistics, total, features = [], [], 0, {}
    with h5py.File(episodes, "r") as file:
        data = file["data"]
        for episode in range(len(data)):
            demo = data[f"demo_{episode}"]
            names = sorted(demo["obs"]) if observations is None else list(observations)
            state, action = _rows(demo["obs"], names), _rows(demo, ["actions"])
            n = len(action)
            columns = {
                "observation.state": state,
                "action": action,
                "next.reward": numpy.asarray(demo["rewards"], dtype=numpy.float32),
                "next.done": numpy.asarray(demo["dones"], dtype=bool),
                "timestamp": (numpy.arange(n) / fps).astype(numpy.float32),
                "frame_index": numpy.arange(n),
                "episode_index": numpy.full(n, episode),
                "index": numpy.arange(total, total + n),
                "task_index": numpy.zeros(n, dtype=int),
            }
            labels = {"observation.state": _labels(demo["obs"], names), "action": _labels(demo, ["actions"])}
            features = {
                name: {"dtype": str(column.dtype), "shape": list(column.shape[1:]) or [1], "names": labels.get(name)}
                for name, column in columns.items()
            }
            path = os.path.join(folder, _PATH.format(episode_chunk=episode // _CHUNK, episode_index=episode))
            os.makedirs(os.path.dirname(path), exist_ok=True)
            lists = {name: list(column) if column.ndim > 1 else column for name, column in columns.items()}
            parquet.write_table(pyarrow.table(lists), path)
            lengths.append({"episode_index": episode, "tasks": [task], "length": n})
            some = {name: _statistics(column) for name, column in columns.items()}
            statistics.append({"episode_index": episode, "stats": some})
            total += n
    _write_lines(os.path.join(folder, "meta", "episodes.jsonl"), lengths)
    _write_lines(os.path.join(folder, "meta", "episodes_stats.jsonl"), statistics)
    _write_lines(os.path.join(folder, "meta", "tasks.jsonl"), [{"task_index": 0, "task": task}])
    info = {
        "codebase_version": "v2.1", "robot_type": "irdm", "total_episodes": len(lengths), "total_frames": total,
        "total_tasks": 1, "total_videos": 0, "total_chunks": -(-len(lengths) // _CHUNK), "chunks_size": _CHUNK, "fps": fps,
        "splits": {"train": f"0:{len(lengths)}"}, "data_path": _PATH, "video_path": None, "features": features,
    }
    with open(os.path.join(folder, "meta", "info.json"), "w", encoding="utf-8") as file:
        json.dump(info, file, indent=4)
