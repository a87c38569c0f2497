/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: does a reader with a claim read the bytes of its record only, while the publisher
 * neither waits nor is refused because of a stuck reader, and gets the room back in the end?
 *
 * Follows TopicDsmWriter (reclaim, claim_descriptor, try_place, commit) on a ring that may not
 * grow, and Source (claim, release, scan). All messages have the same size, so the data area
 * consists of BLOCKS blocks that the cursor passes in turn. A hint names any record that the reader
 * has not noted: hints arrive late, twice or never. A stopped reader is one that spin schedules no
 * more; reader 0 may be killed at any step, and is then reaped.
 *
 * RUN READERS=1
 * RUN READERS=2 (long)
 * BUG 1: no fence between reading and the load of number (reader)
 * BUG 2: no fence between clearing number and the load of reading (publisher)
 * BUG 3: number cleared after the load of reading
 * BUG 4: number and last stored before the bytes
 * BUG 5: reading cleared before the bytes are read
 * BUG 6: cursor (taken) advanced before the bytes are read
 * BUG 7: descriptor of a pinned record reused
 * BUG 8: a scan pins every record
 * BUG 9: publisher does not learn that a reader was reaped
 * BUG 10: publisher passes each hole only once, although quick readers pin one after the other
 */
#if READERS == 1
#define COUNT 2           /* descriptors: a power of two, more than readers */
#define MESSAGES 3
#define CLAIMS 4          /* of reader 0, at most */
#define KILLABLE 1
#else
#define COUNT 4
#define MESSAGES 1
#define CLAIMS 2
#define KILLABLE 0
#endif
#define BLOCKS (READERS + 1)   /* with all readers stuck, one block is left */

#if BUG == 10
#define ROUNDS 1
#else
#define ROUNDS (READERS + 1)
#endif

#define NUMBER(d) (d)
#define BLOCK(d) (4 + (d))
#define DATA(b) (8 + (b))
#define READING(r) (11 + (r))
#define TAKEN(r) (13 + (r))
#define LAST 15
#define CHANGES 16     /* changes of the topic's bucket */
#define LIVE 17         /* the row of reader 0; reader 1's never changes */
#define WORDS 18
#define PROCESSES 3
#define PUBLISHER 2       /* readers are processes 0 and 1 */

#define no_record 0
#define every_record 255

#include "tso.pml"

byte finished[READERS];   /* records read or given up; for the property only */
byte gone;                /* readers that ended, or died and were reaped */
bool killed, dead;

/* Source */

inline choose_hint() {
  atomic {
    claims > 0 && load(r, LAST) > noted ->
    n = noted + 1;
    do
    :: n < load(r, LAST) -> n++
    :: break
    od
  }
}

inline release() {
  atomic {
    store_seq_cst(r, TAKEN(r), n);
    assert(finished[r] >= n)
  };
  store_release(r, READING(r), no_record)
}

/* Any moment between claim and release. */
inline read_bytes() {
  atomic {
    b = load(r, BLOCK(n % COUNT));
    assert(load(r, DATA(b)) == n);
    b = 0;
    finished[r] = n
  }
}

inline claim() {
#if BUG == 1
  store_release(r, READING(r), n);
#else
  store_seq_cst(r, READING(r), n);
#endif
  atomic {
    holds = load(r, NUMBER(n % COUNT)) == n;
    if
    :: !holds -> finished[r] = n
    :: else
    fi
  }
}

/* `claims` is the maximum number of claims. */
proctype Reader(byte r; byte claims) {
  byte noted, n, b;
  bool holds;
  {
    do
    :: choose_hint();
#if BUG == 8
       store_seq_cst(r, READING(r), every_record);
#endif
       claim();
       if
       :: holds ->
#if BUG == 5
          store_release(r, READING(r), no_record);
#endif
#if BUG == 6
          release();
          read_bytes()
#else
          read_bytes();
          release()
#endif
       :: holds -> store_release(r, READING(r), no_record)   /* a scan: the record stays untaken */
       :: !holds -> release()
       fi;
       atomic { noted = n; n = 0; holds = false; claims-- }
    :: break
    od
  } unless { r == 0 && killed };
  if
  :: r == 0 && killed -> dead = true
  :: else -> gone++
  fi
}

/* SIGKILL at any step of reader 0, or never; the reaper closes its row. */
proctype Reaper() {
  if
  :: KILLABLE -> killed = true;
     if
     :: dead && settled(0) ->
        memory[LIVE] = 0;
#if BUG != 9
        memory[CHANGES]++;
#endif
        gone++
     :: gone == READERS           /* it had ended before */
     fi
  :: skip
  fi
}

/* TopicDsmWriter */

inline refresh() {
  atomic {
    if
    :: load(PUBLISHER, CHANGES) != seen ->
       seen = load(PUBLISHER, CHANGES);
       first_reader = (load(PUBLISHER, LIVE) -> 0 : 1)
    :: else
    fi
  }
}

inline clear_number(n) {
  if
  :: load(PUBLISHER, NUMBER((n) % COUNT)) == (n) ->      /* written by the publisher only */
#if BUG == 2
     store_release(PUBLISHER, NUMBER((n) % COUNT), no_record);
#else
     store_seq_cst(PUBLISHER, NUMBER((n) % COUNT), no_record);
#endif
     refresh();
     maybe_pinned[(n) % COUNT] = n
  :: else
  fi
}

inline look_at(i, n) {
  atomic {
    if
    :: i < first_reader || i >= READERS
    :: else ->
       if
       :: load(PUBLISHER, READING(i)) == (n) -> pinned = true
       :: BUG == 8 && load(PUBLISHER, READING(i)) == every_record -> pinned = true
       :: else
       fi
    fi
  }
}

inline look_at_readers(n) {
  atomic { pinned = false; look_at(0, n) };
  look_at(1, n)
}

/* Takes back free and overwritten records alike. */
inline reclaim(n) {
#if BUG == 3
  look_at_readers(n);
  clear_number(n)
#else
  clear_number(n);
  look_at_readers(n)
#endif
}

inline pass_over(position, next_position, all) {
  atomic {
    assert(!alone);                                      /* alone, nothing is pinned */
    position = next_position;
    tries++;
    assert(tries < all * ROUNDS)                         /* refused (no_space) */
  }
}

inline claim_descriptor() {
  tries = 0;
  do
  :: load(PUBLISHER, NUMBER(next % COUNT)) != no_record ->
     old = load(PUBLISHER, NUMBER(next % COUNT));
     reclaim(old);
     old = no_record
  :: else ->
     if
     :: maybe_pinned[next % COUNT] == no_record || BUG == 7 -> break
     :: else -> look_at_readers(maybe_pinned[next % COUNT])
     fi;
     if
     :: !pinned -> maybe_pinned[next % COUNT] = no_record; break
     :: else -> pass_over(next, next + 1, COUNT)
     fi
  od
}

inline try_place() {
  tries = 0;
  do
  :: held[cursor] == no_record -> break
  :: else ->
     reclaim(held[cursor]);
     if
     :: !pinned -> held[cursor] = no_record; break
     :: else -> pass_over(cursor, (cursor + 1) % BLOCKS, BLOCKS)
     fi
  od
}

inline commit() {
#if BUG == 4
  store_release(PUBLISHER, NUMBER(next % COUNT), next);
  store_seq_cst(PUBLISHER, LAST, next);
#endif
  store_release(PUBLISHER, DATA(cursor), next);
  store_release(PUBLISHER, BLOCK(next % COUNT), cursor);
#if BUG != 4
  store_release(PUBLISHER, NUMBER(next % COUNT), next);
  store_seq_cst(PUBLISHER, LAST, next);
#endif
  d_step {
    held[cursor] = next;
    cursor = (cursor + 1) % BLOCKS;
    next++;
    published++;
    pinned = false;
    tries = 0
  }
}

inline publish() {
  refresh();
  claim_descriptor();
  try_place();
  commit()
}

proctype Publisher() {
  byte next = BLOCKS + 1, cursor, published, tries, old, first_reader, seen;
  byte held[BLOCKS];
  byte maybe_pinned[COUNT];
  bool pinned, alone;
  d_step {
    for (tries : 1 .. BLOCKS) {
      held[tries - 1] = tries
    };
    tries = 0
  };
  do
  :: published < MESSAGES || (alone && published < MESSAGES + BLOCKS) -> publish()
  :: published == MESSAGES && !alone ->
     atomic { gone == READERS && settled(0) && settled(1) -> alone = true }
  :: published == MESSAGES + BLOCKS -> break
  od
}

/* Starts with a full ring, of which nothing is taken. */
init {
  byte i;
  atomic {
    for (i : 1 .. BLOCKS) {
      memory[NUMBER(i % COUNT)] = i;
      memory[BLOCK(i % COUNT)] = i - 1;
      memory[DATA(i - 1)] = i
    };
    memory[LAST] = BLOCKS;
    memory[LIVE] = 1;
    run StoreBuffer(0); run StoreBuffer(1); run StoreBuffer(PUBLISHER);
    run Reader(0, CLAIMS); run Reaper(); run Publisher();
    if
    :: READERS == 2 -> run Reader(1, 1)
    :: else
    fi
  }
}
