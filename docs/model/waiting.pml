/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: does a thread that sleeps for its next notification wake for each one, and is the
 * system call avoided while the thread is awake?
 *
 * Follows WakeWord::notify, Watchers, thread_number(), Waiters::forget_this_thread and Waiter::wait
 * (mode block), with two threads, each waiting for its own entity, and one notifier per entity. A
 * thread takes the number that threads have to themselves, or shares a wake word if it is taken.
 * The model relies neither on fences inside the kernel nor on spurious wake-ups.
 * OWN=0: no thread has a number to itself, so both share a word.
 * GRAPH=1: the entities are those of which the notifier first looks whether any thread of the
 * process has ever watched one (Registry::graph_changed, Waiters::watch_graph).
 *
 * RUN GRAPH=0 OWN=0 (long)
 * RUN GRAPH=0 OWN=1
 * RUN GRAPH=1 OWN=1 (long)
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
 * BUG 14: a thread forgets a word that it shares
 * BUG 15 GRAPH=0 OWN=1: watchers not added again after they were forgotten
 * BUG 16 GRAPH=1 OWN=1: process marked as watching only after the entities were checked
 * BUG 17 GRAPH=1 OWN=1: mark loaded before the hint is pushed
 * BUG 18 GRAPH=1 OWN=1: a thread that forgets what it waits for takes the mark off its process
 * BUG 19 GRAPH=0 OWN=1 (reversed): a thread forgets a word while another one begins to share it
 */
#define EPOCH(w) (w)
#define SLEEPERS(w) (2 + (w))
#define HINT(i) (4 + (i))
#define WATCHERS(i) (6 + (i))   /* of entity i: wake words, one bit each */
#define MARK 8                  /* whether the process has ever watched */
#define WORDS 9
#define PROCESSES 4

#define NOTIFIER(i) (i)
#define WAITER(i) (2 + (i))
#define MESSAGES 2

/* Wake words. */
#define UNIQUE 0
#define SHARED 1
#define bit(w) (1 << (w))
/* A counter that is not changed by a locked instruction can count for one process only. */
#define PAIRS (BUG == 1 || BUG == 2 || BUG == 10 || BUG == 11 || BUG == 12 || BUG == 13 || \
               BUG == 16 || BUG == 17 -> 1 : 2)

#include "tso.pml"

bool asleep[2];           /* in the kernel's queue */
byte word[2];             /* of a thread */
byte inside[2];           /* threads that have counted themselves as sleepers on a word */
bool is_taken = !OWN;     /* the number that a thread has to itself */
bool is_any_shared;       /* BUG 19: a thread looks at this before it forgets its word */

inline fetch_add_seq_cst(p, a, d) {
  d_step { settled(p) -> memory[a] = memory[a] + d }
}

inline wake(w) {
#if BUG == 7
  d_step {
    if
    :: asleep[0] && word[0] == w -> asleep[0] = false
    :: else -> if :: word[1] == w -> asleep[1] = false :: else fi
    fi
  }
#else
  d_step {
    if :: word[0] == w -> asleep[0] = false :: else fi;
    if :: word[1] == w -> asleep[1] = false :: else fi
  }
#endif
}

inline raise_epoch(p, w) {
#if BUG == 1
  next = load(p, EPOCH(w)) + 1;
  store_release(p, EPOCH(w), next)
#else
  fetch_add_seq_cst(p, EPOCH(w), 1)
#endif
}

inline notify(p, w) {
#if BUG == 5
  counted = load(p, SLEEPERS(w));
  raise_epoch(p, w);
  if
  :: counted > 0 -> wake(w)
  :: else
  fi
#else
  raise_epoch(p, w);
  if
  :: atomic { BUG == 9 || load(p, SLEEPERS(w)) > 0 -> assert(inside[w] > 0) };
     wake(w)
  :: BUG != 9 && load(p, SLEEPERS(w)) == 0
  fi
#endif
}

inline notify_watchers(p, i) {
  set = load(p, WATCHERS(i));
  if
  :: set & bit(UNIQUE) -> notify(p, UNIQUE)
  :: else
  fi;
  if
  :: set & bit(SHARED) -> notify(p, SHARED)
  :: else
  fi;
  set = 0
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
  byte counted, message, next, set;
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
     set = load(NOTIFIER(i), WATCHERS(i));
     store_seq_cst(NOTIFIER(i), HINT(i), message);
     if
     :: set & bit(SHARED) -> notify(NOTIFIER(i), SHARED)
     :: else
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

inline count_sleeper(p, w) {
#if BUG == 2
  next = load(p, SLEEPERS(w)) + 1;
  store_release(p, SLEEPERS(w), next);
  inside[w]++
#else
  atomic { settled(p) -> memory[SLEEPERS(w)]++; inside[w]++ }
#endif
}

/* futex_wait: the kernel compares and queues atomically. */
inline futex_wait(p, i) {
  atomic {
    if
    :: load(p, EPOCH(word[i])) == seen -> asleep[i] = true
    :: else
    fi
  };
  !asleep[i]
}

inline sleep(p, i) {
#if BUG == 3
  if
  :: load(p, EPOCH(word[i])) == seen ->
     count_sleeper(p, word[i]);
     asleep[i] = true;
     !asleep[i];
     atomic { settled(p) -> memory[SLEEPERS(word[i])]--; inside[word[i]]-- }
  :: else
  fi
#else
  count_sleeper(p, word[i]);
  if
  :: load(p, EPOCH(word[i])) == seen -> futex_wait(p, i); slept = true
  :: else -> slept = false
  fi;
  atomic {
    settled(p) ->
    if :: BUG != 8 || slept -> memory[SLEEPERS(word[i])]-- :: else fi;
    inside[word[i]]--
  }
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
  :: !(load(p, WATCHERS(i)) & bit(word[i])) ->
#if BUG == 11
     next = load(p, WATCHERS(i));
     store_release(p, WATCHERS(i), next | bit(word[i]))
#else
     d_step { settled(p) -> memory[WATCHERS(i)] = memory[WATCHERS(i)] | bit(word[i]) }
#endif
  :: else
  fi
}

inline remove_everywhere(p, w) {
  d_step { settled(p) -> memory[WATCHERS(0)] = memory[WATCHERS(0)] & ~bit(w) };
  d_step { settled(p) -> memory[WATCHERS(1)] = memory[WATCHERS(1)] & ~bit(w) }
#if BUG == 18
  ;
  store_seq_cst(p, MARK, 0)
#endif
}

/* Called after a wake-up for nothing. */
inline forget(p, i) {
#if BUG == 14
  remove_everywhere(p, word[i]);
#elif BUG == 19
  if
  :: !is_any_shared -> remove_everywhere(p, word[i])
  :: else
  fi;
#else
  if
  :: word[i] != SHARED -> remove_everywhere(p, word[i])
  :: else
  fi;
#endif
#if BUG != 15
  watch(p, i)
#endif
}

inline take_number(i) {
  atomic {
    if
    :: !is_taken -> is_taken = true; word[i] = UNIQUE
    :: else ->
#if BUG == 19
      is_any_shared = true;
      word[i] = UNIQUE
#else
      word[i] = SHARED
#endif
    fi
  }
}

inline give_number_back(i) {
  atomic {
    if
    :: BUG != 19 && word[i] == UNIQUE -> is_taken = false
    :: else
    fi
  }
}

proctype WaitingThread(byte i) {
  byte seen, taken, next;
  bool slept;
  take_number(i);
  do
  :: taken < MESSAGES ->
#if BUG == 12
     if
     :: load(WAITER(i), HINT(i)) == taken ->
        watch(WAITER(i), i);
        seen = load(WAITER(i), EPOCH(word[i]));
        sleep(WAITER(i), i)
     :: else -> taken = load(WAITER(i), HINT(i))
     fi
#elif BUG == 4
     watch(WAITER(i), i);
     if
     :: load(WAITER(i), HINT(i)) == taken ->
        seen = load(WAITER(i), EPOCH(word[i]));
        sleep(WAITER(i), i)
     :: else -> taken = load(WAITER(i), HINT(i))
     fi
#else
     watch(WAITER(i), i);
     do
     :: seen = load(WAITER(i), EPOCH(word[i]));
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
  od;
  give_number_back(i)
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
