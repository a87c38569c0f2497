/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: does the subscriber queue keep each hint exactly once and in order, or count it as
 * displaced, whichever process dies at whatever step?
 *
 * Follows subscriber_queue::push, ::pop and, with COUNTED, SubscriptionHeader::displaced statement
 * by statement. Each store of `head`, `tail` and slots is a compare-and-swap, a full fence on x86,
 * and those of the pops are seen in order there, so store buffers are not modelled.
 *
 * The word of a slot is {lap mod LAPS, source}, without the record number, so two hints of one
 * source differ by their lap only. This is the worst case for a delayed compare-and-swap, which is
 * safe unless a pusher sleeps through LAPS laps of its slot. This run makes fewer than 8 laps; the
 * real queue has 65,536, and 2^28 numbers that would have to wrap at the same time.
 *
 * RUN DEPTH=1
 * RUN DEPTH=2
 * RUN DEPTH=1 SLOTS=2
 * RUN DEPTH=3 SLOTS=4
 * RUN DEPTH=1 COUNTED=1
 * BUG 1: no lap in the word
 * BUG 2: laps modulo 2: a pusher that sleeps through two laps overwrites a later hint
 * BUG 3: tail advanced before the slot is filled
 * BUG 4: fullness computed from a tail that head has passed
 * BUG 5: oldest hint displaced without compare-and-swap
 * BUG 6 DEPTH=2: pop does not load head again after it loaded the slot
 * BUG 7: the push of a pusher that died before it advanced tail is never finished
 * BUG 8 DEPTH=1 COUNTED=1: a pop counts as begun only once it has moved head
 * BUG 9 DEPTH=1 COUNTED=1: the pops that have begun are loaded before head
 * BUG 10 DEPTH=1 COUNTED=1: a pop that finds its hint displaced stays begun
 */
#ifdef COUNTED
#define PUSHES 0          /* one pusher and the popper move head */
#define KILLED_PUSHES 3   /* may also displace a hint and fill no slot */
#else
#define PUSHES 3
#define KILLED_PUSHES 1
#endif
#ifndef SLOTS
#define SLOTS DEPTH       /* the next power of two */
#endif
#define PUSHERS 2
#define LAST_PUSHER 2     /* starts when the others are done, to check that the queue still works */

#if BUG == 1
#define LAPS 1
#elif BUG == 2
#define LAPS 2
#else
#define LAPS 8
#endif

#define HELP (BUG != 3 && BUG != 7)

#define lap(position) (((position) / SLOTS) % LAPS)
#define encode(position, source) (lap(position) * 4 + (source) + 1)
#define source_of(word) ((word) % 4 - 1)
#define filled(word, position) ((word) / 4 == lap(position))
#define at(position) ((position) % SLOTS)

byte slot[SLOTS];
byte head = SLOTS;        /* positions start at lap 1; lap 0 is "never filled" */
byte tail = SLOTS;
byte pops_begun;
byte pops_done;

/* For the properties only; the protocol does not read these. */
byte number[SLOTS];       /* record number of the hint in the slot */
byte waiting;             /* hints pushed, neither popped nor displaced */
byte displaced;
byte last_popped[3];      /* record number, by source */
bool was_empty;           /* at some moment during the current pop */
bool overtaken[3];        /* some word changed during this pusher's current attempt */
byte ended;               /* pushers that finished or died */
bool killed;

inline word_changed() {
  overtaken[0] = true; overtaken[1] = true; overtaken[2] = true
}

/* compare_exchange(tail, seen, seen + 1) */
inline advance_tail(seen) {
  atomic { if :: tail == seen -> tail++; word_changed() :: else fi }
}

inline remove_oldest() {
  head++;
  assert(waiting > 0);
  waiting--;
  was_empty = was_empty || waiting == 0;
  word_changed()
}

inline count_displaced() {
#ifdef COUNTED
  displaced++
#else
  skip
#endif
}

inline fill(position, source, record) {
  slot[at(position)] = encode(position, source);
  number[at(position)] = record;
  waiting++;
  word_changed()
}

/* Uses t, h, word of the process. Each atomic step is one access to a shared word, and what follows
 * from it. */
inline push(source, record) {
  skip;
attempt:
  atomic { overtaken[source] = false; h = 0; word = 0; t = tail };
  atomic {
    word = slot[at(t)];
    if
    :: HELP && filled(word, t) -> goto help
    :: else
    fi
  };
#if BUG == 4
  h = head;
#else
  h = head;
  atomic {
    if
    :: tail != t -> goto failed           /* from here on head <= tail is known */
    :: else
    fi
  };
#endif
  if
  :: t < h || t - h >= DEPTH -> goto displace   /* unsigned: t - h of a passed tail is huge */
  :: else
  fi;
#if BUG == 4
  atomic {
    if
    :: tail != t -> goto failed           /* the word may belong to a later lap */
    :: else
    fi
  };
#endif
#if BUG == 3
  atomic {
    if
    :: tail == t -> tail++; word_changed()
    :: else -> goto failed
    fi
  };
  d_step { fill(t, source, record) };
  goto pushed;
#else
  atomic {
    if
    :: slot[at(t)] == word -> d_step { fill(t, source, record) }
    :: else -> goto failed
    fi
  };
  advance_tail(t);
  goto pushed;
#endif
help:
  advance_tail(t);
  goto failed;
displace:
#if BUG == 5
  atomic { head = h; remove_oldest(); count_displaced() };
#else
  atomic { if :: head == h -> remove_oldest(); count_displaced() :: else fi };
#endif
failed:
  atomic { assert(overtaken[source]); goto attempt };   /* lock-free: it was overtaken */
pushed:
  skip
}

/* Uses h, word, n of the process; sets `found`. */
inline pop() {
  d_step { found = false; was_empty = waiting == 0 };
look:
  atomic { word = 0; n = 0; h = head };
  d_step { word = slot[at(h)]; n = number[at(h)] };
#if BUG != 6
  atomic {
    if
    :: head != h -> goto look             /* displaced meanwhile */
    :: else
    fi
  };
#endif
  if
  :: !filled(word, h) ->
     assert(was_empty);
#if defined(COUNTED) && BUG != 10
     pops_begun = pops_done;
#endif
     goto looked
  :: else
  fi;
  if
  :: HELP -> advance_tail(h)
  :: else
  fi;
#if defined(COUNTED) && BUG != 8
  pops_begun = pops_done + 1;
#endif
  atomic {
    if
    :: head == h ->
       d_step {
         remove_oldest();
         assert(word % 4 != 0);                    /* nothing fabricated */
         assert(n > last_popped[source_of(word)]); /* nothing twice, in order per pusher */
         last_popped[source_of(word)] = n;
         found = true
       }
    :: else -> goto look
    fi
  };
#if BUG == 8
  pops_begun = pops_done + 1;
#endif
#ifdef COUNTED
  pops_done++;
#endif
looked:
  skip
}

proctype Pusher(byte source; byte pushes) {
  byte t, h, word, record;
  {
    skip;
next:
    if
    :: atomic { record < pushes -> record++ };
       push(source, record);
       goto next
    :: record == pushes
    fi
  } unless { killed && source == 0 };
  ended++
}

/* SIGKILL at any step of the first pusher, or never. */
proctype Killer() {
  if
  :: killed = true
  :: skip
  fi
}

proctype LastPusher() {
  byte t, h, word;
  push(LAST_PUSHER, 1);
  ended++
}

proctype Popper() {
  byte h, word, n;
  bool found, all_ended;
  do
  :: all_ended = ended == PUSHERS;
     pop();
     if
     :: all_ended && !found -> break
     :: else
     fi
  od;
  assert(waiting == 0);
#ifdef COUNTED
  assert(pops_begun == pops_done && head - SLOTS - pops_done == displaced);
#endif
  run LastPusher();
  ended == PUSHERS + 1;
  assert(tail == head + 1 && waiting == 1)
}

/* One attempt to count the displaced hints, at any moment. */
proctype Counter() {
  byte done, moves, begun, truth;
#if BUG == 9
  begun = pops_begun;
#endif
  done = pops_done;
  d_step { moves = head - SLOTS; truth = displaced };
#if BUG != 9
  begun = pops_begun;
#endif
  atomic {
    assert(begun != done || moves - begun == truth);
    assert(moves < begun || moves - begun <= truth);
    done = 0; moves = 0; begun = 0; truth = 0
  }
}

init {
  atomic {
#ifdef COUNTED
    run Counter();
#endif
    run Pusher(0, KILLED_PUSHES); run Pusher(1, PUSHES); run Killer(); run Popper()
  }
}
