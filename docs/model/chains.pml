/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: does a new endpoint that walks along its topic's chain without the registry lock find
 * each older one that stays, or notice that it was led astray?
 *
 * Follows Registry::for_each_older, next_of, link_endpoint, unlink_endpoint, Table::take and the
 * chains of Registry::repair. Its own endpoint and the oldest one stay; those between leave under
 * the lock, and their slots come back in front of its own chain, or in another one. The owner of
 * the lock is killed at any step, and the next one repairs. There is one at a time that stores, and
 * the walk only loads, so what x86 does with stores cannot be seen: these are plain variables.
 *
 * BUG 1: a step counts though the endpoint where it stood has left
 * BUG 2: the link not read again after the incarnation of the next one
 * BUG 3: incarnation raised when the endpoint is in its chain
 * BUG 4: incarnation not raised at the next use
 * BUG 5: a repair links by slot, not by age
 */
#define OWN 0
#define OLDEST 3
#define STRANGER 4        /* alone in the other chain */
#define SLOTS 5
#define NOTHING 5
#define MOVES 2

bool live[SLOTS];
byte incarnation[SLOTS];
byte next[SLOTS];
byte chain[SLOTS];        /* which its topic belongs to */
byte order[SLOTS];
byte first[2];            /* the buckets */
byte last_order;
bool left[SLOTS];
byte moves;
bool killed;

inline link(i) {
  next[i] = first[chain[i]];
  first[chain[i]] = i
}

/* What leads to slot i, and past it. */
inline unlink(i) {
  if
  :: first[chain[i]] == i -> first[chain[i]] = next[i]
  :: else ->
     d_step {
       before = 0;
       do
       :: before < SLOTS && (next[before] != i || !live[before] || chain[before] != chain[i]) ->
          before++
       :: else -> break
       od
     }
     if
     :: before < SLOTS -> next[before] = next[i]
     :: else
     fi
  fi
}

inline leave(i) {
  left[i] = true;
  live[i] = false;
  unlink(i)
}

inline come(i, where) {
#if BUG != 3 && BUG != 4
  incarnation[i]++;
#endif
  chain[i] = where;
  last_order++;
  order[i] = last_order;
  live[i] = true;
  link(i);
#if BUG == 3
  incarnation[i]++
#endif
}

proctype Changer() {
  byte i, before;
  {
    do
    :: moves < MOVES ->
       moves++;
       if
       :: i = 1
       :: i = 2
       fi;
       leave(i);
       if
       :: come(i, 0)
       :: come(i, 1)
       :: skip
       fi;
       if
       :: !live[i] -> break
       :: else
       fi
    :: else -> break
    od
  } unless { killed }
}

/* The next owner of the lock: all links anew, from the oldest endpoint on. */
proctype Repairer() {
  byte i, o;
  killed -> first[0] = NOTHING;
  first[1] = NOTHING;
#if BUG == 5
  for (i : 0 .. SLOTS - 1) {
    if
    :: live[i] -> link(i)
    :: else
    fi
  }
#else
  for (o : 1 .. last_order) {
    for (i : 0 .. SLOTS - 1) {
      if
      :: live[i] && order[i] == o -> link(i)
      :: else
      fi
    }
  }
#endif
}

proctype Killer() {
  killed = true
}

inline read_next() {
  read = next[slot];
#if BUG != 1
  if
  :: live[slot] -> is_astray = (incarnation[slot] != mine)
  :: else -> is_astray = true
  fi
#endif
}

proctype Walker() {
  byte slot, mine, read, found, of_found;
  bool is_astray, visited[SLOTS];
  slot = OWN;
  mine = incarnation[OWN];
  do
  :: read_next();
     if
     :: is_astray -> break
     :: else
     fi;
     if
     :: read == NOTHING ->
        assert(visited[OLDEST] && (visited[1] || left[1]) && (visited[2] || left[2]));
        break
     :: else
     fi;
     found = read;
     of_found = incarnation[found];
#if BUG != 2
     read_next();
     if
     :: is_astray || read != found -> break
     :: else
     fi;
#endif
     slot = found;
     mine = of_found;
     visited[slot] = true
  od
}

init {
  atomic {
    /* From the youngest to the oldest, by chance not in the order of their slots. */
    first[0] = OWN; next[OWN] = 2; next[2] = 1; next[1] = OLDEST; next[OLDEST] = NOTHING;
    first[1] = STRANGER; next[STRANGER] = NOTHING; chain[STRANGER] = 1;
    order[OLDEST] = 1; order[STRANGER] = 2; order[1] = 3; order[2] = 4; order[OWN] = 5;
    last_order = 5;
    live[0] = true; live[1] = true; live[2] = true; live[3] = true; live[4] = true;
    run Changer();
    run Killer();
    run Repairer();
    run Walker()
  }
}
