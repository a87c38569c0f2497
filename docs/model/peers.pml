/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: what does an endpoint know of its peers, where it looks at their rows when `changes`
 * moved and no process counts for it? Does it know in the end which ones are there, is none counted
 * twice, and does it tell a publisher that died from one that left?
 *
 * Promised: a peer that is there during a look is counted, once; one that comes and goes between two
 * looks is not. A known peer that died counts as dead if its slot was not taken again before the
 * next look; else as one that left. Peers come and go in one slot. The owner of the registry lock is
 * the only process that stores, and a look only loads, so shared words are plain variables, as in
 * chains.pml, which is about the walk.
 *
 * BUG 1: incarnation not compared after the row is read
 * BUG 2: closed before it is noted how the peer ended
 * BUG 3: changes raised before the row is changed
 * BUG 4: peers known by their slots alone
 * BUG 5: the row read before changes is loaded
 * BUG 6: closing does not raise changes
 * BUG 7: incarnation raised after the row is live again
 */
#define PEERS 3
#define left 1
#define died 2

bool live;                /* the row */
byte incarnation;
byte end_of;              /* how the peer ended; 0 = it has not */
byte changes;
bool all_done;

/* For the properties only. */
byte how[PEERS + 1];
bool counted[PEERS + 1], counted_dead[PEERS + 1];
bool is_taken_again[PEERS + 1];   /* its slot */

inline come(i) {
#if BUG == 3
  changes++;
#endif
#if BUG != 7
  incarnation = i;
#endif
  end_of = 0;
  live = true;
#if BUG == 7
  incarnation = i;
#endif
#if BUG != 3
  changes++
#endif
}

inline end(i, which) {
#if BUG == 3
  changes++;
#endif
  how[i] = which;
#if BUG == 2
  live = false;
  end_of = which;
#else
  end_of = which;
  live = false;
#endif
#if BUG != 3 && BUG != 6
  changes++
#endif
}

proctype Changer() {
  byte i;
  do
  :: i < PEERS ->
     i++;
     is_taken_again[i - 1] = true;
     come(i);
     if
     :: end(i, left)
     :: end(i, died)
     :: i == PEERS           /* stays */
     fi
  :: i == PEERS || i > 0 -> break
  od;
  all_done = true
}

inline forget(is_dead) {
  counted_dead[known] = is_dead;
  current--;
  known = 0
}

inline read_row() {
  i = incarnation;
  is_live = live;
  e = end_of
}

inline look() {
#if BUG == 5
  read_row();
#endif
  now = changes;
  if
  :: now != seen ->
#if BUG != 5
     do
     :: read_row();
        if
        :: incarnation == i || BUG == 1 -> break
        :: else
        fi
     od;
#endif
     seen = now;
     atomic {
       if
       :: known != 0 && ((i != known && BUG != 4) || !is_live) ->
          assert(e != died || i != known || how[known] == died);
          forget(e == died && (i == known || BUG == 4))
       :: else
       fi;
       if
       :: is_live && known == 0 ->
          assert(!counted[i]);
          counted[i] = true;
          known = i;
          current++
       :: else
       fi;
       i = 0; e = 0; is_live = false; now = 0
     }
  :: else
  fi
}

proctype Endpoint() {
  byte i, e, now, seen, known, current;
  bool is_live, is_last;
  do
  :: is_last = all_done;
     look();
     if
     :: is_last -> break
     :: else
     fi
  od;
  assert(current == live && (!live || known == incarnation));
  for (i : 1 .. PEERS) {
    assert(!counted_dead[i] || how[i] == died);
    assert(!counted[i] || how[i] != died || is_taken_again[i] || counted_dead[i])
  }
}

init {
  atomic { run Changer(); run Endpoint() }
}
