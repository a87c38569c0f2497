/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: is a seat one reader's at a time, although seats are used again and the table grows while
 * readers look for theirs, so that a publisher never takes a record for read that its reader has not
 * read?
 *
 * The publisher alone gives seats and grows the table, without the registry lock but for the SMEM of
 * the block (hands.pml). It frees the seat of a reader whose row is not live: its process has stopped
 * using it, or is dead. A reader looks for the seat that names it, row and incarnation, and from then
 * on is the only one to write `taken`. The memory of a new block says what its former use left, here
 * the worst case: the second reader's name. Reader 1 closes after a take, or is killed at any step
 * and then closed by its reaper. Reader 2 comes at any time.
 *
 * BUG 1: block attached before it is cleared
 * BUG 2: owner stored before taken
 * BUG 3: row closed before the last release
 * BUG 4 (reversed) (long): a killed reader's row is closed before its process has stopped
 * BUG 5: a seat is given again although the row of its reader is live
 * BUG 6: block attached before the seat's former owner is cleared from it, but after taken
 */
#define OWNER(s) (s)
#define TAKEN(s) (2 + (s))
#define BLOCKS 4          /* of the table; one seat each */
#define CHANGES 5
#define LIVE(r) (5 + (r)) /* of readers 1 and 2 */
#define LAST 8
#define WORDS 9
#define PROCESSES 3
#define PUBLISHER 0       /* readers are processes 1 and 2 */
#define MESSAGES 2
#define garbage 9

#include "tso.pml"

bool killed, has_stopped;

/* For the properties only. */
byte done[3];             /* what a reader has read, or did not want */
byte starts[3] = garbage; /* where the publisher lets it start */
bool has_ended;

/* Under the registry lock. */
inline change(live) {
  store_release(r, LIVE(r), live);
  d_step { settled(r) -> memory[CHANGES]++ }
}

inline give(s, reader) {
  d_step { start = n - 1; starts[reader] = start; done[reader] = (start > done[reader] -> start : done[reader]) };
#if BUG == 2
  store_release(PUBLISHER, OWNER(s), reader);
  store_release(PUBLISHER, TAKEN(s), start)
#else
  store_release(PUBLISHER, TAKEN(s), start);
  store_release(PUBLISHER, OWNER(s), reader)
#endif
}

inline grow() {
#if BUG == 1
  store_release(PUBLISHER, BLOCKS, 2);
#endif
  store_release(PUBLISHER, TAKEN(1), 0);
#if BUG == 6
  store_release(PUBLISHER, BLOCKS, 2);
#endif
  store_release(PUBLISHER, OWNER(1), 0);
#if BUG != 1 && BUG != 6
  store_release(PUBLISHER, BLOCKS, 2)
#endif
}

#define is_free(s) (load(PUBLISHER, OWNER(s)) == 0)
#define has_left(s) (!is_free(s) && !load(PUBLISHER, LIVE(load(PUBLISHER, OWNER(s)))))

inline free_seat(s) {
  if
  :: s < load(PUBLISHER, BLOCKS) && (has_left(s) || (BUG == 5 && n == MESSAGES)) ->
     store_release(PUBLISHER, OWNER(s), 0)
  :: else
  fi
}

inline seat_of(reader) {
  if
  :: load(PUBLISHER, LIVE(reader)) ->
     if
     :: load(PUBLISHER, OWNER(0)) == reader || (load(PUBLISHER, BLOCKS) == 2 &&
                                           load(PUBLISHER, OWNER(1)) == reader)
     :: else ->
        if
        :: is_free(0) -> give(0, reader)
        :: !is_free(0) ->
           if
           :: load(PUBLISHER, BLOCKS) == 1 -> grow()
           :: else
           fi;
           if
           :: is_free(1) -> give(1, reader)
           :: else
           fi
        fi
     fi
  :: else
  fi
}

inline check(s) {
  atomic {
    if
    :: s < load(PUBLISHER, BLOCKS) && !is_free(s) && load(PUBLISHER, LIVE(load(PUBLISHER, OWNER(s)))) ->
       assert(load(PUBLISHER, TAKEN(s)) <= done[load(PUBLISHER, OWNER(s))])
    :: else
    fi
  }
}

proctype Publisher() {
  byte n, seen, start;
  do
  :: n < MESSAGES ->
     n++;
     store_seq_cst(PUBLISHER, LAST, n);
     if
     :: load(PUBLISHER, CHANGES) != seen ->
        seen = load(PUBLISHER, CHANGES);
        free_seat(0);
        free_seat(1);
        seat_of(1);
        seat_of(2)
     :: else
     fi;
     check(0);
     check(1)
  :: n == MESSAGES -> break
  od;
  check(0);
  check(1);
  has_ended = true
}

inline release(s) {
  atomic {
    assert(has_met || load(r, TAKEN(s)) == starts[r]);
    has_met = true
  };
  d_step { done[r] = (n > done[r] -> n : done[r]) };
  store_seq_cst(r, TAKEN(s), n)
}

/* Takes what there is, once or twice. */
inline take() {
  n = load(r, LAST);
  if
  :: n > 0 && load(r, OWNER(0)) == r -> release(0)
  :: n > 0 && load(r, OWNER(0)) != r && load(r, BLOCKS) == 2 && load(r, OWNER(1)) == r ->
     release(1)
  :: else
  fi
}

proctype Reader(byte r) {
  byte n;
  bool has_met;
  {
    change(1);
    take();
    if
    :: take()
    :: skip
    fi;
#if BUG == 3
    change(0);
    take()
#else
    change(0)
#endif
  } unless { r == 1 && killed };
  if
  :: r == 1 -> has_stopped = true
  :: else
  fi
}

/* Kills and reaps, or not. */
proctype Reaper() {
  if
  ::
#if BUG != 4
     killed = true;
     has_stopped && settled(1);
#endif
     memory[LIVE(1)] = 0;
     memory[CHANGES]++;
     killed = true
  :: skip
  fi
}

init {
  atomic {
    memory[BLOCKS] = 1;
    memory[OWNER(1)] = 2;
    memory[TAKEN(1)] = garbage;
    memory[TAKEN(0)] = garbage;
    run StoreBuffer(PUBLISHER); run StoreBuffer(1); run StoreBuffer(2);
    run Publisher(); run Reader(1); run Reader(2); run Reaper()
  }
}
