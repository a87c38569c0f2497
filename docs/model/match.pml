/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: does a subscription that is created while a publisher is created and publishes get each
 * message from its creation on exactly once, and the history if both are transient local, although
 * neither end writes into the other one's lists?
 *
 * The subscription stores its row and raises the topic's `changes`; it reads nothing of the
 * publisher. The publisher looks at `changes` before it makes a record, after it cleared the number
 * of an old one, and after it stored `last`. A reader that it finds gets a seat in the publisher's
 * memory, which says where that reader starts, before any hint: one of the history at its beginning. The claim is one word in the
 * subscription's memory, so it needs no seat. A seat is used again after its former reader is gone:
 * it starts with that one's `taken`. A message may be missed for one reason only: the publisher
 * overwrote its record, knowing that the reader wanted it. Any hint may find the pipe full; the
 * reader then looks for itself. The queue is long enough, and the
 * publisher waits for a pinned record.
 *
 * RUN HISTORY=0
 * RUN HISTORY=1
 * BUG 1: publisher does not load changes again after it stored last
 * BUG 2: no fence between last and the load of changes
 * BUG 3 HISTORY=1: publisher does not load changes again after it cleared number
 * BUG 4: changes raised before the subscription's row is live
 * BUG 5: publisher walks along the chain before it loads changes
 * BUG 6: a reader found after last was stored starts behind that record
 * BUG 7: seat's owner stored before where it starts
 * BUG 8: seat given after the hint
 * BUG 9: duplicates not ignored
 * BUG 10: resync cleared after the scan
 * BUG 11: queue drained after the scan
 * BUG 12: scan noted up to a last that was loaded after it
 * BUG 13 HISTORY=1: history is read before changes is raised
 * BUG 14 HISTORY=1: history is not scanned for
 * BUG 15: no fence between reading and the load of number
 * BUG 16: no fence between number cleared and the load of reading
 * BUG 17 HISTORY=1: a reader of the history starts behind the record before the one in work
 */
#define MESSAGES 3
#define COUNT 2

#define NUMBER(d) (d)
#define DATA(d) (2 + (d))
#define LAST 4
#define CHANGES 5         /* of the topic's bucket */
#define LIVE 6            /* row of the subscription */
#define PUBLISHER_LIVE 7  /* row of the publisher */
#define OWNER 8           /* of the seat; written by the publisher */
#define TAKEN 9           /* of the seat; written by the publisher until OWNER, then by the reader */
#define READING 10        /* of the subscription */
#define WORDS 11
#define PROCESSES 2
#define PUBLISHER 0
#define READER 1

#include "tso.pml"

bool resync = HISTORY && BUG != 14;
chan queue = [MESSAGES] of { byte };
bool published_all;

/* For the properties only. */
byte first_possible;      /* a volatile reader gets none published before it was created */
byte first_wanted = MESSAGES + 1;
byte delivered[MESSAGES + 1];
bool overwritten[MESSAGES + 1];

inline raise(p) {
  d_step { settled(p) -> memory[CHANGES]++ }
}

inline give_seat() {
  if
  :: knows_reader && load(PUBLISHER, OWNER) == 0 ->
#if BUG == 7
     store_release(PUBLISHER, OWNER, 1);
#endif
     start = (BUG == 6 -> load(PUBLISHER, LAST) : (HISTORY && BUG != 17 -> 0 : n - 1));
     store_release(PUBLISHER, TAKEN, start);
#if BUG != 7
     store_release(PUBLISHER, OWNER, 1)
#endif
  :: else
  fi
}

inline refresh() {
#if BUG == 5
  knows_reader = load(PUBLISHER, LIVE);
#endif
  now = load(PUBLISHER, CHANGES);
  if
  :: now != seen ->
#if BUG != 5
     knows_reader = load(PUBLISHER, LIVE);
#endif
#if BUG != 8
     give_seat();
#endif
     seen = now
  :: else
  fi
}

inline reclaim(old) {
  atomic {
    overwritten[old] = HISTORY || (knows_reader && load(PUBLISHER, TAKEN) < old);
#if BUG == 16
    store_release(PUBLISHER, NUMBER((old) % COUNT), 0)
#else
    store_seq_cst(PUBLISHER, NUMBER((old) % COUNT), 0)
#endif
  };
#if BUG != 3
  refresh();
#endif
  !knows_reader || load(PUBLISHER, READING) != (old)
}

proctype Publisher() {
  byte n, now, seen, start;
  bool knows_reader;
  store_release(PUBLISHER, PUBLISHER_LIVE, 1);           /* under the registry lock */
  raise(PUBLISHER);
  do
  :: n < MESSAGES ->
     n++;
     refresh();
     if
     :: n > COUNT -> reclaim(n - COUNT)
     :: else
     fi;
     store_release(PUBLISHER, DATA(n % COUNT), n);
     store_release(PUBLISHER, NUMBER(n % COUNT), n);
#if BUG == 2
     store_release(PUBLISHER, LAST, n);
#else
     store_seq_cst(PUBLISHER, LAST, n);
#endif
#if BUG != 1
     refresh();
#endif
     if
     :: knows_reader -> settled(PUBLISHER); queue!n      /* a compare-and-swap */
     :: knows_reader -> settled(PUBLISHER); resync = true               /* full pipe */
     :: else
     fi;
#if BUG == 8
     give_seat()
#endif
  :: n == MESSAGES -> break
  od;
  settled(PUBLISHER);
  published_all = true
}

inline meet() {
  if
  :: !met && load(READER, OWNER) != 0 ->
     met = true;
     noted = (load(READER, TAKEN) > noted -> load(READER, TAKEN) : noted)
  :: else
  fi
}

inline take(n) {
#if BUG == 15
  store_release(READER, READING, n);
#else
  store_seq_cst(READER, READING, n);
#endif
  meet();
  if
  :: met && (n > noted || is_listed || BUG == 9) ->
     if
     :: load(READER, NUMBER(n % COUNT)) == n ->
        atomic {
          assert(load(READER, DATA(n % COUNT)) == n);
          delivered[n]++;
          assert(n > last_delivered);
          last_delivered = n
        }
     :: else
     fi;
     noted = (n > noted -> n : noted);
     if
     :: load(READER, OWNER) != 0 -> store_seq_cst(READER, TAKEN, n)
     :: else
     fi
  :: else
  fi;
  store_release(READER, READING, 0);
  is_listed = false
}

inline empty_queue() {
  do
  :: queue?_
  :: empty(queue) -> break
  od
}

inline scan() {
  meet();
  if
  :: HISTORY && load(READER, PUBLISHER_LIVE) -> met = true
  :: else
  fi;
  if
  :: met ->
     last = load(READER, LAST);
     n = noted + 1;
     do
     :: atomic { n <= last ->
          if
          :: load(READER, NUMBER(n % COUNT)) == n -> backlog!n
          :: else
          fi;
          n++
        }
     :: n > last -> break
     od;
#if BUG == 12
     last = load(READER, LAST);
#endif
     atomic { noted = (last > noted -> last : noted); last = 0; n = 0 }
  :: else
  fi
}

inline look_at_everything() {
#if BUG != 10
  resync = false;
#endif
#if BUG == 11
  scan();
  empty_queue();
#else
  empty_queue();
  scan();
#endif
#if BUG == 10
  resync = false
#endif
}

/* Under the registry lock. */
inline create() {
#if BUG == 13
  look_at_everything();
#endif
  first_possible = (HISTORY -> 1 : load(READER, LAST));
#if BUG != 4
  store_release(READER, LIVE, 1);
#endif
  atomic { settled(READER) -> raise(READER); first_wanted = (HISTORY -> 1 : memory[LAST] + 1) };
#if BUG == 4
  store_seq_cst(READER, LIVE, 1)
#endif
}

proctype Subscription() {
  chan backlog = [MESSAGES] of { byte };
  byte n, noted, last, last_delivered;
  bool met, is_listed;
  create();
  do
  :: resync -> look_at_everything()
  :: !resync && nempty(backlog) -> backlog?n; is_listed = true; take(n); n = 0
  :: empty(backlog) && !resync && nempty(queue) ->
     queue?n;
     if
     :: resync -> look_at_everything()                   /* finds n as well */
     :: else -> take(n)
     fi;
     n = 0
  :: atomic { published_all && !resync && empty(queue) && empty(backlog) -> break }
  od;
  n = 1;
  do
  :: n <= MESSAGES ->
     assert(delivered[n] <= 1);
     assert(n >= first_possible || delivered[n] == 0);
     assert(n < first_wanted || delivered[n] == 1 || overwritten[n]);
     n++
  :: else -> break
  od
}

/* Another publisher's death. */
proctype Other() {
  if
  :: resync = true
  :: skip
  fi
}

init {
  atomic {
    memory[TAKEN] = MESSAGES;                            /* of the seat's former reader */
    run StoreBuffer(PUBLISHER); run StoreBuffer(READER);
    run Publisher(); run Subscription(); run Other()
  }
}
