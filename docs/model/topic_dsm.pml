/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: is the topic DSM of a gone publisher freed only when no subscription can access it any
 * more, and always freed in the end, though a subscription looks at it because of a stale hint or is
 * killed in its look? Is the next publisher in the same slot and the same memory unharmed? Are
 * messages that are never taken counted as lost once, by the subscription or by the process that
 * frees?
 *
 * A look is one word in the subscription's memory, `reading`, which names publisher and record. It
 * counts while the subscription's row is live. After it is stored, the publisher's row says whether
 * the memory is there. The receive thread reads the row only, never the topic DSM, so it cannot
 * stand in the way; its eMCOS message may be late by a whole publisher, which is one more stale
 * hint. Freeing stores the row's state before it loads `reading`; a subscription that ends its look
 * loads the state after it cleared `reading`, and tells the reaper.
 *
 * BUG 1: no fence between reading and the load of the row
 * BUG 2: freed without checking reading
 * BUG 3: state stored after the load of reading
 * BUG 4: a look does not compare the publisher's incarnation
 * BUG 5: a refused look advances the cursor
 * BUG 6: reading cleared before the waiting publisher is notified
 * BUG 7: no fence between reading cleared and the load of the state: the reaper is not told
 * BUG 8: a look that ends does not tell the reaper
 * BUG 9: incarnation raised after the row is live again
 * BUG 10: losses counted before reading is checked
 * BUG 11: losses counted before the state is stored
 * BUG 12: the look of a killed subscription counts for ever
 * BUG 13: a killed subscription's row is closed before its process has stopped
 * BUG 14: the seat is looked for before reading is stored
 * BUG 15: no fence between the state and the load of reading
 */
#define STATE 0           /* of the publisher's row */
#define INCARNATION 1     /* of the publisher's row */
#define READING 2         /* of the subscription: the incarnation of the publisher that it names */
#define TAKEN 3           /* of the seat, in the publisher's memory */
#define ACCOUNTED 4       /* of the seat */
#define WORDS 5
#define PROCESSES 2
#define READER 0
#define SWEEPER 1

#define free_slot 0
#define has_memory 1      /* live or closed */
#define freeing 2

#define NUMBER 9          /* last record of the first publisher; the next one starts with lower ones */

#include "tso.pml"

byte lost;                /* for the property: messages of the first publisher */
byte owner = 1;           /* of the topic DSM's memory: 1, 0 (none), 2 */
bool subscription_lives = true;   /* its row is live */
bool killed, reader_ended, told;
chan queue = [2] of { byte };     /* stale hints: the incarnation that they name */

/* Any access to the memory of publisher `whose`'s topic DSM. */
inline touch(whose) {
  assert(owner == whose)
}

inline end_look() {
#if BUG == 7
  store_release(READER, READING, 0);
#else
  store_seq_cst(READER, READING, 0);
#endif
#if BUG != 8
  if
  :: load(READER, STATE) == freeing -> told = true
  :: else
  fi
#endif
}

inline release(whose) {
  store_seq_cst(READER, TAKEN, NUMBER);
#if BUG == 6
  store_release(READER, READING, 0);
  touch(whose);
  end_look()
#else
  touch(whose);                                        /* wakes a waiting publisher */
  end_look()
#endif
}

/* The claim of a record that may be gone already. */
inline look(n) {
#if BUG == 14
  touch(n);
#endif
#if BUG == 1
  store_release(READER, READING, n);
#else
  store_seq_cst(READER, READING, n);
#endif
  may_look = load(READER, STATE) == has_memory;
#if BUG != 4
  may_look = may_look && load(READER, INCARNATION) == n;
#endif
  if
  :: may_look ->
     touch(n);                                         /* seat, number, descriptor, bytes */
     atomic {
       missing = NUMBER - load(READER, ACCOUNTED);
       store_release(READER, ACCOUNTED, NUMBER);
       lost = lost + missing;
       missing = 0
     };
     release(n)
  :: !may_look ->
#if BUG == 5
     store_seq_cst(READER, TAKEN, NUMBER);
#endif
     end_look()
  fi;
  may_look = false
}

proctype Reader() {
  bool may_look;
  byte n, missing;
  {
    do
    :: queue?n -> look(n)
    :: atomic { empty(queue) -> break }
    od
  } unless { killed };
  reader_ended = true
}

/* Pushes the hint of an eMCOS message that waited in the pipe, at any time. */
proctype ReceiveThread() {
  queue!1
}

/* Kills and reaps, or not. */
proctype Reaper() {
  if
  ::
#if BUG == 13
     subscription_lives = false;
#endif
     killed = true;
     reader_ended && settled(READER);
     subscription_lives = false;
     told = true                                       /* a graph change: the reaper looks again */
  :: skip
  fi
}

inline count_lost() {
  atomic {
    lost = lost + NUMBER - load(SWEEPER, ACCOUNTED);
    store_release(SWEEPER, ACCOUNTED, NUMBER)
  }
}

#if BUG == 12
#define is_read() (load(SWEEPER, READING) == 1)
#else
#define is_read() (subscription_lives && load(SWEEPER, READING) == 1)
#endif

/* A sweep that finds the topic DSM in use gives up, and is repeated when the reaper is told. */
inline see_readers_out() {
  do
  :: is_read() -> told; told = false
  :: !is_read() -> break
  od
}

inline free_topic_dsm() {
#if BUG == 11
  count_lost();
#endif
#if BUG == 3
  see_readers_out();
#endif
#if BUG == 15
  store_release(SWEEPER, STATE, freeing);
#else
  store_seq_cst(SWEEPER, STATE, freeing);
#endif
#if BUG == 10
  count_lost();
#endif
#if BUG != 2 && BUG != 3
  see_readers_out();
#endif
#if BUG != 10 && BUG != 11
  count_lost();
#endif
  owner = 0;
  store_release(SWEEPER, STATE, free_slot)
}

inline create_second_publisher() {
  owner = 2;
  store_release(SWEEPER, TAKEN, 0);                    /* its seat for the same reader */
  store_release(SWEEPER, ACCOUNTED, 0);
#if BUG != 9
  store_release(SWEEPER, INCARNATION, 2);
#endif
  store_seq_cst(SWEEPER, STATE, has_memory);
#if BUG == 9
  store_release(SWEEPER, INCARNATION, 2);
#endif
  settled(SWEEPER)
}

/* Serialized by the registry lock. */
proctype Sweeper() {
  free_topic_dsm();
  create_second_publisher()
}

init {
  atomic {
    memory[STATE] = has_memory;
    memory[INCARNATION] = 1;
    queue!1;
    run StoreBuffer(READER); run StoreBuffer(SWEEPER);
    run Reader(); run ReceiveThread(); run Reaper(); run Sweeper()
  };
  _nr_pr == 3 && settled(READER) && settled(SWEEPER);
  /* The second publisher's seat starts where it should. */
  assert(memory[TAKEN] == 0 && memory[ACCOUNTED] == 0);
  assert(memory[READING] == 0 || killed);
  assert(lost == NUMBER)
}
