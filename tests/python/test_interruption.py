import os
import signal
import subprocess
import sys
import textwrap
import threading
import time

import pytest
import vmesh


def test_progress_is_told():
    told = []
    vmesh.generate(vmesh.synthetic_tree(1500), progress=lambda stage, fraction: told.append((stage, fraction)))
    assert "grow" in {stage for stage, _ in told}
    assert all(0 <= fraction <= 1 for _, fraction in told)


def test_progress_can_cancel():
    with pytest.raises(vmesh.Cancelled):
        vmesh.generate(vmesh.synthetic_tree(1500), progress=lambda stage, fraction: stage != "grow")


def test_what_progress_raises_comes_out():
    def fail(stage, fraction):
        raise LookupError(stage)

    with pytest.raises(LookupError):
        vmesh.generate(vmesh.synthetic_tree(1500), progress=fail)
    with pytest.raises(TypeError):
        vmesh.generate(vmesh.synthetic_tree(10), progress=3)


def test_other_threads_go_on():
    ticks = 0
    done = threading.Event()

    def tick():
        nonlocal ticks
        while not done.wait(0.001):
            ticks += 1

    thread = threading.Thread(target=tick)
    thread.start()
    begin = time.monotonic()
    vmesh.generate(vmesh.synthetic_tree(1500), threads=1)
    took = time.monotonic() - begin
    done.set()
    thread.join()
    # It would not tick at all while a call holds the lock. A busy machine gives it a tenth of its time at least.
    assert ticks > 0.1 * took / 0.001 * 0.1


@pytest.mark.parametrize(
    "call",
    [
        "vmesh.generate(large)",
        "vmesh.fit(vmesh.generate(tree), vmesh.generate(tree, around=9), rounds=100)",
        "[vmesh.evaluate(grown, grown, tree, samples=10**6) for i in range(1000)]",
        "[vmesh.hausdorff(grown, other, tolerance=1e-9) for i in range(1000)]",
        "deformation.step(10**9)",
    ],
)
def test_ctrl_c_raises_keyboard_interrupt(call):
    program = f"""
        import os, signal, threading, time, vmesh
        signal.signal(signal.SIGINT, signal.default_int_handler)  # what runs in the background begins without
        tree = vmesh.synthetic_tree(400)
        large = vmesh.synthetic_tree({10000 if "large" in call else 2})
        grown, other = vmesh.generate(tree), vmesh.generate(tree, around=12)
        deformation = vmesh.Deformation(grown, rest_tolerance=0)
        deformation.set_gravity([0, 0, -9810])
        threading.Timer(1, os.kill, (os.getpid(), signal.SIGINT)).start()
        begin = time.monotonic()
        try:
            {call}
        except KeyboardInterrupt:
            print("interrupted", vmesh.generate(tree).vertices.shape == grown.vertices.shape)
    """
    run = subprocess.run([sys.executable, "-c", textwrap.dedent(program)], capture_output=True, text=True, timeout=120)
    assert run.stdout == "interrupted True\n", run.stderr
    assert run.returncode == 0


def test_a_handler_of_ones_own_is_heard():
    heard = []
    before = signal.signal(signal.SIGUSR1, lambda number, frame: heard.append(number))
    try:
        threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGUSR1)).start()
        vmesh.generate(vmesh.synthetic_tree(1500), threads=1)
        assert heard == [signal.SIGUSR1]
    finally:
        signal.signal(signal.SIGUSR1, before)
