/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: does a subscription that joins while its publisher publishes get each message from its
 * join on exactly once, and, if both are transient local, what the ring still holds from before?
 *
 * Follows join in matching.cpp, the publisher's ReaderList::refresh in reclaim and commit,
 * RecordFinder (next, resync) and Subscription::claim. The subscription already serves other
 * publishers, so resync may be set at any time. A message may be missed for one reason only: its
 * record was overwritten. The queue is long enough here (for a short one see queue.pml), and the
 * publisher waits for a pinned record instead of skipping it (see record.pml).
 *
 * RUN HISTORY=0
 * RUN HISTORY=1
 * BUG 1: publisher does not load match_generation again after it stored last
 * BUG 2: no fence between last and the load of match_generation
 * BUG 3: messages published during the match are not scanned for
 * BUG 4: source active before match_generation is incremented
 * BUG 5: duplicates not ignored
 * BUG 6: resync cleared after the scan
 * BUG 7: queue drained after the scan
 * BUG 8: scan noted up to a last that was loaded after it
 * BUG 9: publisher does not load match_generation again after it cleared number
 * BUG 10: a volatile match starts at the first record
 * BUG 11 HISTORY=1: history is not scanned for
 * BUG 12 HISTORY=1: a hint is taken before the history of its new source
 */
#define MESSAGES 3
#define COUNT 2

#define NUMBER(d) (d)
#define DATA(d) (2 + (d))
#define LAST 4
#define GENERATION 5      /* match_generation */
#define ACTIVE 6          /* of the reader table's entry */
#define STATE 7           /* of the source */
#define TAKEN 8
#define READING 9
#define SOURCE_GENERATION 10
#define WORDS 11
#define PROCESSES 3
#define PUBLISHER 0
#define MATCHER 1
#define READER 2

#define unused 0
#define joining 1
#define active 2

#include "tso.pml"

bool resync;
chan queue = [MESSAGES] of { byte };
bool published_all, joined;

/* For the properties only. */
byte first_wanted;        /* the match promises the records from this one on */
byte delivered[MESSAGES + 1];
bool overwritten[MESSAGES + 1];

inline raise(p, a) {
  d_step { settled(p) -> memory[a]++ }
}

inline refresh() {
  atomic {
    if
    :: load(PUBLISHER, GENERATION) != seen ->
       seen = load(PUBLISHER, GENERATION);
       knows_reader = load(PUBLISHER, ACTIVE)
    :: else
    fi
  }
}

inline reclaim(old) {
  atomic { store_seq_cst(PUBLISHER, NUMBER((old) % COUNT), 0); overwritten[old] = true };
#if BUG != 9
  refresh();
#endif
  !knows_reader || load(PUBLISHER, READING) != (old)
}

proctype Publisher() {
  byte n, seen;
  bool knows_reader;
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
     :: else
     fi
  :: n == MESSAGES -> break
  od;
  settled(PUBLISHER);
  published_all = true
}

inline open_source() {
  store_seq_cst(MATCHER, STATE, active);
  raise(MATCHER, SOURCE_GENERATION)
}

proctype Matcher() {
  byte taken;
  atomic {
    taken = (HISTORY || BUG == 10 -> 0 : load(MATCHER, LAST));
    first_wanted = (HISTORY -> 1 : load(MATCHER, LAST) + 1)
  };
  store_release(MATCHER, TAKEN, taken);
  store_release(MATCHER, STATE, joining);
#if BUG == 4
  open_source();
#endif
  store_release(MATCHER, ACTIVE, 1);
  raise(MATCHER, GENERATION);
#if BUG != 4
  open_source();
#endif
  if
  :: atomic { BUG != 3 && BUG != 11 && load(MATCHER, LAST) > taken -> resync = true }
  :: else
  fi;
  joined = true
}

inline renew_readers() {
  atomic {
    if
    :: !known && load(READER, SOURCE_GENERATION) != 0 && load(READER, STATE) == active ->
       known = true;
       added = true;
       noted = load(READER, TAKEN)
    :: else
    fi
  }
}

inline take(n) {
  store_seq_cst(READER, READING, n);
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
  atomic { store_seq_cst(READER, TAKEN, n); noted = (n > noted -> n : noted) };
  store_release(READER, READING, 0)
}

inline empty_queue() {
  do
  :: queue?_
  :: empty(queue) -> break
  od
}

inline scan() {
  renew_readers();
  if
  :: known ->
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
#if BUG == 8
     last = load(READER, LAST);
#endif
     atomic { noted = (last > noted -> last : noted); last = 0; n = 0 }
  :: else
  fi
}

inline look_at_everything() {
#if BUG != 6
  resync = false;
#endif
#if BUG == 7
  scan();
  empty_queue();
#else
  empty_queue();
  scan();
#endif
#if BUG == 6
  resync = false
#endif
}

proctype Subscription() {
  chan backlog = [MESSAGES] of { byte };
  byte n, noted, last, last_delivered;
  bool known, added;
  do
  :: resync -> look_at_everything()
  :: backlog?n -> take(n); n = 0
  :: empty(backlog) && !resync && nempty(queue) ->
     queue?n;
     added = false;
     renew_readers();
     if
     :: added && BUG != 12 -> look_at_everything()      /* finds n as well */
     :: (!added || BUG == 12) && known && (n > noted || BUG == 5) && n <= load(READER, LAST) ->
        take(n)
     :: else
     fi;
     n = 0
  :: atomic { published_all && joined && !resync && empty(queue) && empty(backlog) -> break }
  od;
  n = 1;
  do
  :: n <= MESSAGES ->
     assert(n >= first_wanted || delivered[n] == 0 || HISTORY);
     assert(n < first_wanted || delivered[n] == 1 || (delivered[n] == 0 && overwritten[n]));
     n++
  :: else -> break
  od
}

/* Another publisher's match, death or full pipe. */
proctype Other() {
  if
  :: resync = true
  :: skip
  fi
}

init {
  atomic {
    run StoreBuffer(PUBLISHER); run StoreBuffer(MATCHER); run StoreBuffer(READER);
    run Publisher(); run Matcher(); run Subscription(); run Other()
  }
}
