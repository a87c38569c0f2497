/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: is the topic DSM of a gone publisher freed only when no process can access it any more,
 * and does a late reader leave the next match intact, which may get the same source entry and the
 * same memory? Are messages that the reader never takes counted as lost once, by the reader or by
 * the sweeper?
 *
 * Follows freeing.cpp (sweep_publisher, revoke), count_undelivered, matching.cpp (join), Source
 * (claim, release) and ReceiveThread::forward. The subscription holds a hint of the first publisher
 * whose record is already gone. A sweep that finds the topic DSM in use gives up, and is repeated
 * later.
 *
 * BUG 1: no fence between reading and the load of state
 * BUG 2: revoked without checking reading
 * BUG 3: state revoked after the load of reading
 * BUG 4: claim does not compare the source's incarnation
 * BUG 5: a refused claim advances the cursor
 * BUG 6: reading cleared before the waiting publisher is notified
 * BUG 7: receive thread: no fence between phase and the load of the slot
 * BUG 8: freed while the receive thread is in its phase
 * BUG 9: incarnation incremented after the source is active again
 * BUG 10: sweeper counts losses before it checks reading
 * BUG 11: sweeper counts losses before the source is revoked
 * BUG 12: receive thread checks the topic DSM's header instead of the publisher's slot
 * BUG 13: reader loads last for the hint's full number without a claim
 */
#define STATE 0           /* of the source */
#define INCARNATION 1
#define READING 2
#define TAKEN 3
#define SLOT 4            /* publisher whose memory may be accessed; 0 = freeing */
#define PHASE 5           /* of the receive thread */
#define ACCOUNTED 6       /* of the source */
#define WORDS 7
#define PROCESSES 3
#define READER 0
#define RECEIVER 1
#define SWEEPER 2

#define free_source 0
#define active 1
#define revoked 2

#define header_only 255
#define NUMBER 9          /* of the stale hint; the next publisher starts with lower ones */

#include "tso.pml"

byte lost;                /* for the property: messages of the first publisher */
byte owner = 1;           /* of the topic DSM's memory: 1, 0 (none), 2 */

/* Any access to the memory of publisher `whose`'s topic DSM. */
inline touch(whose) {
  assert(owner == whose)
}

inline release(whose) {
  store_seq_cst(READER, TAKEN, NUMBER);
#if BUG == 6
  store_release(READER, READING, 0);
  touch(whose)
#else
  touch(whose);                                        /* notify_waiting_publisher */
  store_release(READER, READING, 0)
#endif
}

inline look_at_last() {
#if BUG != 13
  store_seq_cst(READER, READING, header_only);
#endif
  if
  :: load(READER, STATE) == active && load(READER, INCARNATION) == 1 || BUG == 13 -> touch(1)
  :: else
  fi;
#if BUG != 13
  store_release(READER, READING, 0)
#endif
}

/* Has found the source of the first publisher and is about to claim. */
proctype Reader() {
  bool may_look;
  look_at_last();
#if BUG == 1
  store_release(READER, READING, NUMBER);
#else
  store_seq_cst(READER, READING, NUMBER);
#endif
  may_look = load(READER, STATE) == active;
#if BUG != 4
  may_look = may_look && load(READER, INCARNATION) == 1;
#endif
  if
  :: may_look ->
     touch(1);                                         /* number, descriptor, bytes */
     lost = lost + NUMBER - load(READER, ACCOUNTED);
     store_release(READER, ACCOUNTED, NUMBER);
     release(1)
  :: !may_look ->
#if BUG == 5
     store_seq_cst(READER, TAKEN, NUMBER);
#endif
     store_release(READER, READING, 0)
  fi
}

/* Has an eMCOS message of the first publisher. */
proctype ReceiveThread() {
#if BUG == 7
  store_release(RECEIVER, PHASE, 1);
#else
  store_seq_cst(RECEIVER, PHASE, 1);
#endif
#if BUG == 12
  touch(1);
#endif
  if
  :: load(RECEIVER, SLOT) == 1 -> touch(1)              /* the header, the reader table */
  :: else
  fi;
  store_release(RECEIVER, PHASE, 0)
}

inline count_undelivered() {
  lost = lost + NUMBER - load(SWEEPER, ACCOUNTED);
  store_release(SWEEPER, ACCOUNTED, NUMBER)
}

inline revoke() {
#if BUG == 11
  count_undelivered();
#endif
#if BUG == 3
  load(SWEEPER, READING) == 0;
  store_seq_cst(SWEEPER, STATE, revoked);
#else
  store_seq_cst(SWEEPER, STATE, revoked);
#if BUG == 10
  count_undelivered();
#endif
#if BUG != 2
  load(SWEEPER, READING) == 0;
#endif
#endif
#if BUG != 10 && BUG != 11
  count_undelivered();
#endif
  store_release(SWEEPER, STATE, free_source)
}

inline free_topic_dsm() {
  store_seq_cst(SWEEPER, SLOT, 0);
#if BUG != 8
  load(SWEEPER, PHASE) == 0;
#endif
  owner = 0
}

inline join_second_publisher() {
  owner = 2;
  store_seq_cst(SWEEPER, SLOT, 2);
#if BUG != 9
  store_release(SWEEPER, INCARNATION, 2);
#endif
  store_release(SWEEPER, TAKEN, 0);
  store_release(SWEEPER, ACCOUNTED, 0);
  store_seq_cst(SWEEPER, STATE, active);
#if BUG == 9
  store_release(SWEEPER, INCARNATION, 2);
#endif
  settled(SWEEPER)
}

/* Serialized by the registry lock. */
proctype Sweeper() {
  revoke();
  free_topic_dsm();
  join_second_publisher()
}

init {
  atomic {
    memory[STATE] = active;
    memory[INCARNATION] = 1;
    memory[SLOT] = 1;
    run StoreBuffer(READER); run StoreBuffer(RECEIVER); run StoreBuffer(SWEEPER);
    run Reader(); run ReceiveThread(); run Sweeper()
  };
  _nr_pr == 4 && settled(READER) && settled(RECEIVER) && settled(SWEEPER);
  /* The second match starts where it should. */
  assert(memory[TAKEN] == 0 && memory[ACCOUNTED] == 0 && memory[READING] == 0);
  assert(lost == NUMBER)
}
