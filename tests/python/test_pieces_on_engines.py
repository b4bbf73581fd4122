# SPDX-License-Identifier: GPL-3.0-or-later
"""Pieces on engines: processes of this machine, and a cluster of two workers, one of which dies."""

from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from operator import methodcaller

import discrete_fairing as df
import numpy as np
import pytest
from piece_files import fair_file
from piece_meshes import torus


@pytest.fixture(scope="module")
def pieces():
    return df.pieces(*torus(noise=0.02), 2, count=6, rings=2)


@pytest.fixture(scope="module")
def joined(pieces):
    return df.join(piece.fair() for piece in pieces)


@pytest.fixture(scope="module")
def client():
    distributed = pytest.importorskip("distributed")
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        yield client


def test_processes_of_this_machine(pieces, joined):
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        parts = pool.map(methodcaller("fair", threads=1), pieces)
        assert np.array_equal(df.join(parts).vertices, joined.vertices)


def test_a_cluster_of_two_workers(client, pieces, joined):
    parts = client.gather(client.map(methodcaller("fair", threads=1), pieces))
    assert np.array_equal(df.join(parts).vertices, joined.vertices)


def test_a_worker_is_killed_in_mid_run(client, pieces, joined, tmp_path):
    """Workers read pieces and write parts; one of them is killed at its piece."""
    paths = []
    for piece in pieces:
        paths.append(tmp_path / f"piece-{piece.index}.npz")
        piece.save(paths[-1])
    deadly = tmp_path / "deadly"
    deadly.touch()
    before = addresses(client)
    tasks = [
        client.submit(fair_file, path, deadly if k == 2 else None, pure=False)
        for k, path in enumerate(paths)
    ]
    parts = client.gather(tasks)
    assert not deadly.exists()
    assert np.array_equal(df.join(parts).vertices, joined.vertices)
    assert {path.name for path in tmp_path.iterdir()} == {
        f"{kind}-{k}.npz" for kind in ("piece", "part") for k in range(6)
    }
    client.wait_for_workers(2)
    assert addresses(client) != before  # one is new


def addresses(client):
    return set(client.scheduler_info()["workers"])
