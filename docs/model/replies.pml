/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: does a client take each reply, or count it as lost, once, although replies to others lie
 * between those to it, hints are displaced and records are overwritten; and does it lose none whose
 * hint is still on its way?
 *
 * The server numbers the replies to each client by themselves. For each it stores `last_reply`, the
 * number of the record, then `replies`, the number of the reply, both in the client's seat; then it
 * pushes the hint, in its phase. A client that finds its queue empty compares `replies` with what it
 * has accounted for. It may count what it has not noted only if no hint is on its way: the server is
 * out of its phase, and the queue is empty after that. One client, a queue of one hint, one
 * descriptor. The server waits for a pinned record.
 *
 * BUG 1: replies stored before last_reply
 * BUG 2: last_reply loaded before replies
 * BUG 3: the server's phase is not looked at
 * BUG 4: the queue is looked at before the phase
 * BUG 5: the phase ends before the hint is pushed
 * BUG 6: replies loaded again after the server's phase
 * BUG 7: a taken reply does not show those missing before it
 */
#define NUMBER 0          /* of the one descriptor */
#define SEQUENCE 1        /* of the reply in it */
#define LAST_REPLY 2
#define REPLIES 3
#define PHASE 4
#define READING 5
#define WORDS 6
#define PROCESSES 2
#define SERVER 0
#define CLIENT 1
#define MESSAGES 3

#include "tso.pml"

chan queue = [1] of { byte };
bool has_ended;

/* For the properties only; by the number of the reply. */
byte delivered[MESSAGES + 1], counted[MESSAGES + 1];
bool displaced[MESSAGES + 1], overwritten[MESSAGES + 1];
byte reply_of[2 * MESSAGES + 1];

inline push(n) {
  atomic {
    settled(SERVER);
    if
    :: full(queue) -> queue?old; displaced[reply_of[old]] = true; old = 0
    :: empty(queue)
    fi;
    queue!n
  }
}

proctype Server() {
  byte n, sequence, old;
  do
  :: sequence < MESSAGES ->
     n++;
     if
     :: n++                                              /* a reply to another client */
     :: skip
     fi;
     store_seq_cst(SERVER, PHASE, 1);
     if
     :: load(SERVER, NUMBER) != 0 ->
        atomic { old = load(SERVER, NUMBER); overwritten[load(SERVER, SEQUENCE)] = true };
        store_seq_cst(SERVER, NUMBER, 0);
        load(SERVER, READING) != old;
        old = 0
     :: else
     fi;
     sequence++;
     reply_of[n] = sequence;
     store_release(SERVER, SEQUENCE, sequence);
     store_release(SERVER, NUMBER, n);
#if BUG == 1
     store_release(SERVER, REPLIES, sequence);
     store_seq_cst(SERVER, LAST_REPLY, n);
#else
     store_release(SERVER, LAST_REPLY, n);
     store_seq_cst(SERVER, REPLIES, sequence);
#endif
#if BUG == 5
     store_release(SERVER, PHASE, 0);
     push(n)
#else
     push(n);
     store_release(SERVER, PHASE, 0)
#endif
  :: else -> break
  od;
  settled(SERVER);
  has_ended = true
}

/* Counts replies up to a number as lost, unless they are accounted for. */
inline account_for(last, is_taken) {
  d_step {
    do
    :: accounted < last ->
       accounted++;
       if
       :: is_taken && accounted == last
       :: else -> counted[accounted]++
       fi
    :: else -> break
    od
  }
}

inline take(n) {
  store_seq_cst(CLIENT, READING, n);
  if
  :: n > noted && load(CLIENT, NUMBER) == n ->
     d_step { sequence = load(CLIENT, SEQUENCE); delivered[sequence]++ };
#if BUG == 7
     accounted = sequence;
#else
     account_for(sequence, true);
#endif
     sequence = 0
  :: else
  fi;
  noted = (n > noted -> n : noted);
  store_release(CLIENT, READING, 0)
}

inline settle() {
#if BUG == 2
  number = load(CLIENT, LAST_REPLY);
  sequence = load(CLIENT, REPLIES);
#else
  sequence = load(CLIENT, REPLIES);
  number = load(CLIENT, LAST_REPLY);
#endif
#if BUG == 4
  is_empty = empty(queue);
  is_announced = is_empty && load(CLIENT, PHASE) == 0;
#else
  is_announced = BUG == 3 || load(CLIENT, PHASE) == 0;
  is_announced = is_announced && empty(queue);
#endif
  if
  :: is_announced || number <= noted ->
#if BUG == 6
     sequence = load(CLIENT, REPLIES);
#endif
     account_for(sequence, false);
     noted = (number > noted -> number : noted)
  :: else
  fi;
  number = 0;
  sequence = 0;
  is_announced = false
}

proctype Client() {
  byte n, noted, accounted, sequence, number;
  bool is_announced, is_empty;
  do
  :: queue?n -> take(n); n = 0
  :: empty(queue) -> settle()
  :: atomic { has_ended && empty(queue) -> break }
  od;
  settle();
  n = 1;
  do
  :: n <= MESSAGES ->
     assert(delivered[n] + counted[n] == 1);
     assert(delivered[n] == 1 || displaced[n] || overwritten[n]);
     n++
  :: else -> break
  od
}

init {
  atomic { run StoreBuffer(SERVER); run StoreBuffer(CLIENT); run Server(); run Client() }
}
