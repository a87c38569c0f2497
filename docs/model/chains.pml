/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: does a process that walks along a topic's chain without the registry lock, from the
 * bucket on, find each endpoint that was there before and stays, though others leave and come where
 * it stands, and an owner of the lock dies?
 *
 * Publishers, subscriptions and receive threads walk whenever `changes` moved. The bucket is where
 * they begin and go back to. A repair may therefore never empty a bucket: it stores the links from the
 * oldest endpoint on, and the bucket last. Each link then leads to the endpoint's older neighbours at
 * any moment, and the bucket to what the dead owner left, which is whole.
 *
 * RUN MOVES=1
 * RUN MOVES=2 (long)
 * BUG 1 (reversed): a step counts although the endpoint where the walk stood has left
 * BUG 2 (reversed): the link is not read again after the incarnation of the next endpoint
 * BUG 3 (reversed): incarnation incremented after the endpoint is in its chain
 * BUG 4 (reversed): incarnation not incremented when the slot is reused
 * BUG 5: a repair links by slot, not by age
 * BUG 6 (reversed): where an endpoint has left, the walk continues with the new incarnation of its slot
 * BUG 7 (reversed): a repair empties the bucket first
 * BUG 8 (reversed): a repair stores the bucket before the links
 */
#define YOUNGEST 0
#define OLDEST 3
#define STRANGER 4        /* alone in the other chain */
#define SLOTS 5
#define NOTHING 5
#define BUCKET 5          /* where a walk begins */

bool live[SLOTS];
byte incarnation[SLOTS];
byte next[SLOTS];
byte chain[SLOTS];        /* bucket of the endpoint's topic */
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

/* Unlinks slot i. */
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

inline relink(i) {
  next[i] = behind[chain[i]];
  behind[chain[i]] = i
}

/* The next owner of the lock stores all links, from the oldest endpoint on. */
proctype Repairer() {
  byte i, o, behind[2];
  killed -> behind[0] = NOTHING;
  behind[1] = NOTHING;
#if BUG == 7
  first[0] = NOTHING;
  first[1] = NOTHING;
#endif
#if BUG == 8
  d_step {
    for (o : 1 .. last_order) {
      for (i : 0 .. SLOTS - 1) {
        if
        :: live[i] && order[i] == o -> first[chain[i]] = i
        :: else
        fi
      }
    }
  };
#endif
#if BUG == 5
  for (i : 0 .. SLOTS - 1) {
    if
    :: live[i] -> relink(i)
    :: else
    fi
  }
#else
  for (o : 1 .. last_order) {
    for (i : 0 .. SLOTS - 1) {
      if
      :: live[i] && order[i] == o -> relink(i)
      :: else
      fi
    }
  }
#endif
  first[0] = behind[0];
  first[1] = behind[1]
}

proctype Killer() {
  killed = true
}

inline read_next() {
  read = (at == 0 -> first[0] : next[slot[at]]);
#if BUG != 1
  if
  :: at == 0 -> is_astray = false
  :: at != 0 && live[slot[at]] -> is_astray = (incarnation[slot[at]] != mine[at])
  :: else -> is_astray = true
  fi
#endif
}

/* Goes back to the last endpoint of the path that has not left, or to the bucket. */
proctype Walker() {
  byte slot[SLOTS + 1], mine[SLOTS + 1], at, read, found, of_found;
  bool is_astray, visited[SLOTS];
  slot[0] = BUCKET;
  do
  :: read_next();
     if
#if BUG == 6
     :: is_astray -> mine[at] = incarnation[slot[at]]
#else
     :: is_astray -> at--
#endif
     :: !is_astray && read == NOTHING ->
        assert(visited[YOUNGEST] && visited[OLDEST] && (visited[1] || left[1]) && (visited[2] || left[2]));
        break
     :: !is_astray && read != NOTHING ->
        found = read;
        of_found = incarnation[found];
#if BUG != 2
        read_next();
#endif
        if
        :: is_astray || read != found
        :: else ->
           at++;
           slot[at] = found;
           mine[at] = of_found;
           visited[found] = true
        fi
     fi
  od
}

init {
  atomic {
    /* From the youngest to the oldest endpoint, deliberately not in slot order. */
    first[0] = YOUNGEST; next[YOUNGEST] = 2; next[2] = 1; next[1] = OLDEST; next[OLDEST] = NOTHING;
    first[1] = STRANGER; next[STRANGER] = NOTHING; chain[STRANGER] = 1;
    order[OLDEST] = 1; order[STRANGER] = 2; order[1] = 3; order[2] = 4; order[YOUNGEST] = 5;
    last_order = 5;
    live[0] = true; live[1] = true; live[2] = true; live[3] = true; live[4] = true;
    run Changer();
    run Killer();
    run Repairer();
    run Walker()
  }
}
