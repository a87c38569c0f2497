/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: does a thread that sleeps for its next notification wake for each one, and is the
 * system call avoided while the thread is awake?
 *
 * Follows WakeWord::notify, Watchers, Waiters::forget_this_thread and Waiter::wait (mode block),
 * with two threads that share one wake word, each waiting for its own entity, and one notifier per
 * entity. The model relies neither on fences inside the kernel nor on spurious wake-ups.
 * GRAPH=1: the entities are those of which the notifier first looks whether any thread of the
 * process has ever watched one (Registry::graph_changed, Waiters::watch_graph).
 *
 * RUN GRAPH=0
 * RUN GRAPH=1
 *
 * BUG 1: no fence between epoch and the load of sleepers
 * BUG 2: no fence between sleepers and the comparison of the epoch
 * BUG 3: sleepers counted after the comparison of the epoch
 * BUG 4: entities checked before the epoch is loaded
 * BUG 5: sleepers loaded before the epoch is incremented
 * BUG 6: notified before the hint is pushed
 * BUG 7: only one sleeper woken
 * BUG 8: sleeper not removed from the count when it did not sleep
 * BUG 9: system call for each notification
 * BUG 10: no fence between the hint and the load of its watchers
 * BUG 11: no fence between adding the word to the watchers and checking the entity
 * BUG 12: entities checked before the word is added to their watchers
 * BUG 13: watchers loaded before the hint is pushed
 * BUG 14: a thread forgets what another thread with the same word waits for
 * BUG 15: watchers not added again after they were forgotten
 * BUG 16 GRAPH=1: process marked as watching only after the entities were checked
 * BUG 17 GRAPH=1: mark loaded before the hint is pushed
 * BUG 18 GRAPH=1: a thread that forgets what it waits for takes the mark off its process
 */
#define EPOCH 0
#define SLEEPERS 1
#define HINT(i) (2 + (i))
#define WATCHERS(i) (4 + (i))   /* of entity i: whether they hold the word */
#define MARK 6                  /* whether the process has ever watched */
#define WORDS 7
#define PROCESSES 4

#define NOTIFIER(i) (i)
#define WAITER(i) (2 + (i))
#define MESSAGES 2
/* A counter that is not changed by a locked instruction can count for one process only. */
#define PAIRS (BUG == 1 || BUG == 2 || BUG == 10 || BUG == 11 || BUG == 12 || BUG == 13 || \
               BUG == 16 || BUG == 17 -> 1 : 2)

#include "tso.pml"

bool asleep[2];           /* in the kernel's queue */
byte inside;              /* threads that have counted themselves as sleepers */

inline fetch_add_seq_cst(p, a, d) {
  d_step { settled(p) -> memory[a] = memory[a] + d }
}

inline wake() {
#if BUG == 7
  d_step { if :: asleep[0] -> asleep[0] = false :: else -> asleep[1] = false fi }
#else
  d_step { asleep[0] = false; asleep[1] = false }
#endif
}

inline raise_epoch(p) {
#if BUG == 1
  next = load(p, EPOCH) + 1;
  store_release(p, EPOCH, next)
#else
  fetch_add_seq_cst(p, EPOCH, 1)
#endif
}

inline notify(p) {
#if BUG == 5
  counted = load(p, SLEEPERS);
  raise_epoch(p);
  if
  :: counted > 0 -> wake()
  :: else
  fi
#else
  raise_epoch(p);
  if
  :: atomic { BUG == 9 || load(p, SLEEPERS) > 0 -> assert(inside > 0) };
     wake()
  :: BUG != 9 && load(p, SLEEPERS) == 0
  fi
#endif
}

inline notify_watchers(p, i) {
  if
  :: load(p, WATCHERS(i)) != 0 -> notify(p)
  :: load(p, WATCHERS(i)) == 0
  fi
}

inline notify_marked(p, i) {
#if GRAPH
  if
  :: load(p, MARK) != 0 -> notify_watchers(p, i)
  :: load(p, MARK) == 0
  fi
#else
  notify_watchers(p, i)
#endif
}

proctype Notifier(byte i) {
  byte counted, message, next;
  do
  :: message < MESSAGES ->
     message++;
#if BUG == 6
     notify_marked(NOTIFIER(i), i);
     store_seq_cst(NOTIFIER(i), HINT(i), message)
#elif BUG == 10
     store_release(NOTIFIER(i), HINT(i), message);
     notify_marked(NOTIFIER(i), i)
#elif BUG == 13
     if
     :: load(NOTIFIER(i), WATCHERS(i)) != 0 ->
        store_seq_cst(NOTIFIER(i), HINT(i), message);
        notify(NOTIFIER(i))
     :: load(NOTIFIER(i), WATCHERS(i)) == 0 -> store_seq_cst(NOTIFIER(i), HINT(i), message)
     fi
#elif BUG == 17
     if
     :: load(NOTIFIER(i), MARK) != 0 ->
        store_seq_cst(NOTIFIER(i), HINT(i), message);
        notify_watchers(NOTIFIER(i), i)
     :: load(NOTIFIER(i), MARK) == 0 -> store_seq_cst(NOTIFIER(i), HINT(i), message)
     fi
#else
     store_seq_cst(NOTIFIER(i), HINT(i), message);
     notify_marked(NOTIFIER(i), i)
#endif
  :: message == MESSAGES -> break
  od
}

inline count_sleeper(p) {
#if BUG == 2
  next = load(p, SLEEPERS) + 1;
  store_release(p, SLEEPERS, next);
  inside++
#else
  atomic { settled(p) -> memory[SLEEPERS]++; inside++ }
#endif
}

/* futex_wait: the kernel compares and queues atomically. */
inline futex_wait(p, i) {
  atomic {
    if
    :: load(p, EPOCH) == seen -> asleep[i] = true
    :: else
    fi
  };
  !asleep[i]
}

inline sleep(p, i) {
#if BUG == 3
  if
  :: load(p, EPOCH) == seen ->
     count_sleeper(p);
     asleep[i] = true;
     !asleep[i];
     atomic { settled(p) -> memory[SLEEPERS]--; inside-- }
  :: else
  fi
#else
  count_sleeper(p);
  if
  :: load(p, EPOCH) == seen -> futex_wait(p, i); slept = true
  :: else -> slept = false
  fi;
  atomic { settled(p) -> if :: BUG != 8 || slept -> memory[SLEEPERS]-- :: else fi; inside-- }
#endif
}

/* Sticky, so that waiting again costs one load. */
inline mark(p) {
  if
  :: GRAPH && load(p, MARK) == 0 -> store_seq_cst(p, MARK, 1)
  :: !GRAPH || load(p, MARK) != 0
  fi
}

inline watch(p, i) {
#if BUG != 16
  mark(p);
#endif
  if
  :: load(p, WATCHERS(i)) == 0 ->
#if BUG == 11
     store_release(p, WATCHERS(i), 1)
#else
     store_seq_cst(p, WATCHERS(i), 1)
#endif
  :: load(p, WATCHERS(i)) != 0
  fi
}

/* Called after a wake-up for nothing. In C++ a shared word is not forgotten; here a thread forgets
 * its own entity only, for which no other thread waits. */
inline forget(p, i) {
  store_seq_cst(p, WATCHERS(i), 0);
#if BUG == 14
  store_seq_cst(p, WATCHERS(1 - (i)), 0);
#elif BUG == 18
  store_seq_cst(p, MARK, 0);
#endif
#if BUG != 15
  watch(p, i)
#endif
}

proctype WaitingThread(byte i) {
  byte seen, taken, next;
  bool slept;
  do
  :: taken < MESSAGES ->
#if BUG == 12
     if
     :: load(WAITER(i), HINT(i)) == taken ->
        watch(WAITER(i), i);
        seen = load(WAITER(i), EPOCH);
        sleep(WAITER(i), i)
     :: else -> taken = load(WAITER(i), HINT(i))
     fi
#elif BUG == 4
     watch(WAITER(i), i);
     if
     :: load(WAITER(i), HINT(i)) == taken ->
        seen = load(WAITER(i), EPOCH);
        sleep(WAITER(i), i)
     :: else -> taken = load(WAITER(i), HINT(i))
     fi
#else
     watch(WAITER(i), i);
     do
     :: seen = load(WAITER(i), EPOCH);
        if
        :: load(WAITER(i), HINT(i)) == taken ->
#if BUG == 16
           mark(WAITER(i));
#endif
           sleep(WAITER(i), i)
        :: else -> break
        fi;
        if
        :: load(WAITER(i), HINT(i)) == taken -> forget(WAITER(i), i)
        :: else
        fi
     od;
     taken = load(WAITER(i), HINT(i))
#endif
  :: taken == MESSAGES -> break
  od
}

/* A thread that misses a wake-up keeps sleeping: spin reports it as an invalid end state. */
init {
  atomic {
    run StoreBuffer(NOTIFIER(0)); run StoreBuffer(NOTIFIER(1));
    run StoreBuffer(WAITER(0)); run StoreBuffer(WAITER(1));
    run Notifier(0);
    run WaitingThread(0);
    if
    :: PAIRS == 2 -> run Notifier(1); run WaitingThread(1)
    :: else
    fi
  }
}
