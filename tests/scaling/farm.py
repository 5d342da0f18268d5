#!/usr/bin/env python3
"""A farm of ranks as a model of discrete events, with recorded tasks.

    farm.py RECORD [--ranks 1,2,4,...] [--slower S] [--latency SECONDS] [--bandwidth BYTES_PER_SECOND]

RECORD is a file by record_tasks: of every task the time of the rank that computes it, its bytes, and the time of the leader that
writes it. The rules are those of src/runs/batch/rank_tasks.f90 and src/runs/batch/task_pool.f90: portions of some milliseconds, smaller towards
the end, the next one handed out before the last one is done, results finished in order in a window. The leader computes, too, while
it has nothing to serve. Prints for every number of ranks: time, speed compared with one rank, share of the leader's time spent
serving, tasks a second.
"""

import argparse
import heapq
from collections import deque

PORTION = 20e-3    # as in rank_tasks.f90
LOOK_AGAIN = 50e-6
MESSAGE = 5e-6     # of the leader, for each message received and sent, beside its bytes


def read_record(path):
    with open(path, encoding="utf-8") as record:
        rows = [line.split() for line in record if not line.startswith("#")]
    return [float(row[0]) for row in rows], [int(row[1]) for row in rows], [float(row[2]) for row in rows]


def window_of(ranks, rows_of_variant=36):
    """As in variant_tasks.f90, of one thread a rank."""
    room = max(1, min(256, 8192//rows_of_variant))
    return max(min(ranks*room, 16384), 2*ranks)


def farm(tasks, ranks, latency, bandwidth, window=None):
    """Time until the last task is written, and the time that the leader spent serving."""
    computing, size, writing = tasks
    count = len(computing)
    window = min(count, window or window_of(ranks))
    following = 0          # next task to hand out
    turn = 0               # next task to write
    done = [False]*count
    spent, counted = 0.0, 0
    serving = 0.0
    portions = [0]*ranks   # that a helper has or waits for
    waiting = deque()
    queues = [deque() for _ in range(ranks)]  # portions that have reached a helper
    idle = [True]*ranks
    events = []            # (time, order, kind, rank, first, last)
    order = 0

    def push(time, kind, rank, first=0, last=-1):
        nonlocal order
        order += 1
        heapq.heappush(events, (time, order, kind, rank, first, last))

    def mean():
        return spent/counted if counted else 2*PORTION

    def take(most):
        nonlocal following
        limit = min(count, turn + window)
        first = following
        following = max(first, min(first + most, limit))
        return first, following - 1

    def finish(number):
        """Writes what has its turn; returns the time that takes."""
        nonlocal turn
        done[number] = True
        time = 0.0
        while turn < count and done[turn]:
            time += writing[turn]
            turn += 1
        return time

    def start_portion(rank, now):
        first, last = queues[rank].popleft()
        idle[rank] = False
        took = sum(computing[first:last + 1])
        push(now + took + latency + sum(size[first:last + 1])/bandwidth, "results", rank, first, last)
        push(now + took, "free", rank)

    for rank in range(1, ranks):
        push(latency, "results", rank)
    inbox = deque()
    leader_free = 0.0      # when the leader has served everything that it knows
    own_task = None        # (number, what is left of it)
    now = 0.0
    last_written = 0.0
    while turn < count:
        # What the leader does next: serve a message, else compute.
        while events and events[0][0] <= now:
            time, _, kind, rank, first, last = heapq.heappop(events)
            if kind == "results":
                inbox.append((rank, first, last))
            elif kind == "tasks":
                queues[rank].append((first, last))
                if idle[rank]:
                    start_portion(rank, time)
            elif queues[rank]:
                start_portion(rank, time)
            else:
                idle[rank] = True
        if inbox:
            rank, first, last = inbox.popleft()
            took = MESSAGE + sum(size[first:last + 1])/bandwidth
            if last < first:
                portions[rank] = 1
            for number in range(first, last + 1):
                spent += computing[number]
                counted += 1
                took += finish(number)
            waiting.append(rank)
            if portions[rank] == 1 and mean() < PORTION:
                portions[rank] = 2
                waiting.append(rank)
            while waiting:
                most = max(1, min(int(PORTION/mean()), (count - following)//(4*ranks)))
                first, last = take(most)
                if last < first and following < count:
                    break
                rank = waiting.popleft()
                if first <= last:
                    took += MESSAGE
                    push(now + took + latency, "tasks", rank, first, last)
            now += took
            serving += took
            last_written = now
            continue
        until = events[0][0] if events else float("inf")
        if own_task is None:
            first, last = take(1)
            if first <= last:
                own_task = [first, computing[first]]
        if own_task is None:
            # No room, or nothing left: the leader looks again and again.
            now = max(until, now + LOOK_AGAIN) if until < float("inf") else now + LOOK_AGAIN
            if until == float("inf") and not inbox and following >= count and turn < count:
                raise RuntimeError("tasks are lost")
            continue
        step = min(own_task[1], until - now)
        now += step
        own_task[1] -= step
        if own_task[1] <= 0.0:
            now += finish(own_task[0])
            last_written = now
            own_task = None
            # Room may have come for those that wait.
            while waiting and following < count:
                first, last = take(max(1, min(int(PORTION/mean()), (count - following)//(4*ranks))))
                if last < first:
                    break
                now += MESSAGE
                push(now + latency, "tasks", waiting.popleft(), first, last)
    return last_written, serving


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", 1)[0])
    parser.add_argument("record")
    parser.add_argument("--ranks", default="1,2,4,8,16,32,64,128,256,512,1000")
    parser.add_argument("--latency", type=float, default=2e-6, help="of a message [s]")
    parser.add_argument("--bandwidth", type=float, default=1e10, help="of the net and of memory [bytes/s]")
    parser.add_argument("--tasks", type=int, default=0, help="number of tasks: those of the record, over and over")
    parser.add_argument("--all-room", action="store_true", help="a window of all tasks, as in sleeping_ranks")
    options = parser.parse_args()
    tasks = read_record(options.record)
    if options.tasks:
        tasks = [(part*(options.tasks//len(part) + 1))[:options.tasks] for part in tasks]
    print(f"{len(tasks[0])} tasks, mean {sum(tasks[0])/len(tasks[0])*1e3:.4f} ms, {sum(tasks[1])/len(tasks[1]):.0f} bytes, "
          f"writing {sum(tasks[2])/len(tasks[2])*1e6:.2f} us")
    print("ranks   time [s]   speed  efficiency  leader serves  tasks/s")
    one = None
    for ranks in map(int, options.ranks.split(",")):
        time, serving = farm(tasks, ranks, options.latency, options.bandwidth, len(tasks[0]) if options.all_room else None)
        one = one or time*ranks
        print(f"{ranks:5d} {time:10.4f} {one/time:7.2f} {one/time/ranks:11.3f} {serving/time:14.3f} {len(tasks[0])/time:8.0f}")


if __name__ == "__main__":
    main()
