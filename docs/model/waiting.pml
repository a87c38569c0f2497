/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: does a process that sleeps for its next notification wake for each one, and is the
 * system call spared while it is awake?
 *
 * Follows WakeWord::notify and Waiter::wait (mode block), with two threads waiting in one process,
 * each for an entity of its own, and one notifier for each entity. Neither the kernel's own fences
 * nor a spurious wake-up are relied on.
 *
 * BUG 1: no fence between epoch and the look at sleepers
 * BUG 2: no fence between sleepers and the comparison of the epoch
 * BUG 3: sleepers counted after the comparison of the epoch
 * BUG 4: entities looked at before the epoch is read
 * BUG 5: sleepers looked at before the epoch is raised
 * BUG 6: notified before the hint is pushed
 * BUG 7: only one sleeper woken
 * BUG 8: sleeper not taken off the count when it did not sleep
 * BUG 9: system call at each notification
 */
#define EPOCH 0
#define SLEEPERS 1
#define HINT(i) (2 + (i))
#define WORDS 4
#define PROCESSES 4

#define NOTIFIER(i) (i)
#define WAITER(i) (2 + (i))
#define MESSAGES 2
/* A counter that is not raised by a locked instruction can count for one process only. */
#define PAIRS (BUG == 1 || BUG == 2 -> 1 : 2)

#include "tso.pml"

bool asleep[2];           /* in the kernel's queue */
byte inside;              /* threads between counting themselves and taking themselves off again */

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

proctype Notifier(byte i) {
  byte counted, message, next;
  do
  :: message < MESSAGES ->
     message++;
#if BUG == 6
     notify(NOTIFIER(i));
     store_release(NOTIFIER(i), HINT(i), message)
#else
     store_release(NOTIFIER(i), HINT(i), message);
     notify(NOTIFIER(i))
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

/* futex_wait: the kernel compares and queues at once. */
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

proctype WaitingThread(byte i) {
  byte seen, taken, next;
  bool slept;
  do
  :: taken < MESSAGES ->
#if BUG == 4
     if
     :: load(WAITER(i), HINT(i)) == taken ->
        seen = load(WAITER(i), EPOCH);
        sleep(WAITER(i), i)
     :: else -> taken = load(WAITER(i), HINT(i))
     fi
#else
     seen = load(WAITER(i), EPOCH);
     if
     :: load(WAITER(i), HINT(i)) == taken -> sleep(WAITER(i), i)
     :: else -> taken = load(WAITER(i), HINT(i))
     fi
#endif
  :: taken == MESSAGES -> break
  od
}

/* A thread that misses a wake-up sleeps on: spin reports it as an invalid end state. */
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
