/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: does a subscription that is stuck keep the memory of at most `depth` gone publishers
 * of its topic, does it still get or count as lost each message that it was owed, once, and is all
 * memory freed once it takes, closes or is killed?
 *
 * A reader is owed what follows the `taken` of its seat, nothing without a seat. The process that
 * closes a publisher gives a seat to each reader of the history that has none, tells the readers
 * that are owed something to look, and sweeps the topic: the newest `depth` gone publishers that
 * the reader is owed something of stay. What else is not being looked at is freed, and counted as
 * lost. Rows stay in the topic's chain until they are freed. One message from each publisher, any of
 * which is killed at any step and then closed by its reaper, and so may the subscription be. The
 * queue holds `depth` hints and displaces the oldest. A step of a process that holds the registry
 * lock is one step; stores and loads of looks are ordered in topic_dsm.pml, those of seats in
 * match.pml.
 *
 * RUN HISTORY=0
 * RUN HISTORY=1
 * BUG 1: gone publishers are not cut
 * BUG 2: the newest ones are cut, not the oldest
 * BUG 3: a reader that is owed something is not told when its publisher closes
 * BUG 4: gone publishers move to a chain of their own, and the reader is told before
 * BUG 5: seats are taken by their readers at the first record met
 * BUG 6: likewise, and one without a seat is owed what it was known for before the commit
 * BUG 7: likewise, but was known for after it, and lost what is not known
 * BUG 8: losses counted without a look at what the seat accounts for
 * BUG 9: the reaper is not told that a look ended
 * BUG 10 HISTORY=1: the closing process gives no seats
 * BUG 11: the closing subscription does not sweep
 * BUG 12: freed although it is being looked at
 * BUG 13: a look does not check the row
 * BUG 14: a subscription that finds all taken does not tell
 * BUG 15: a killed subscription is owed what it was
 * BUG 16 HISTORY=1: a seat accounts for nothing that a reader of the history may have read
 */
#define DEPTH 1
#define PUBLISHERS 2
#define none PUBLISHERS

#define BY_READER (BUG == 5 || BUG == 6 || BUG == 7)

mtype = { live, moving, closed, freeing, freed };
mtype state[PUBLISHERS] = live;
bit last[PUBLISHERS];
bit seat[PUBLISHERS], taken[PUBLISHERS], accounted[PUBLISHERS];
bit known[PUBLISHERS];             /* BUG 6, 7: to the publisher, without a seat */
byte closed_at[PUBLISHERS], closings;
chan queue = [DEPTH] of { byte };
bool subscription_lives, has_stopped, subscription_ended;
bool leaves, killed;
bool resync, told;
byte reading = none;
byte ended;                        /* publishers that are closed */

/* For the properties only. */
bit owed[PUBLISHERS], completed[PUBLISHERS];
bit read_back[PUBLISHERS];         /* history that was there when its publisher closed */
bit cut[PUBLISHERS];
byte delivered[PUBLISHERS], lost[PUBLISHERS];

#define has_memory(p) (state[p] == live || state[p] == closed)
#define is_orphan(p) (state[p] == closed || state[p] == freeing)
#if BUG == 6 || BUG == 7
#define wants(p) (subscription_lives && last[p] && !taken[p] && (seat[p] || known[p]))
#elif BUG == 15
#define wants(p) (last[p] && seat[p] && !taken[p])
#else
#define wants(p) (subscription_lives && last[p] && seat[p] && !taken[p])
#endif

inline try_to_free(p) {
  state[p] = freeing;
  if
  :: subscription_lives && reading == p && BUG != 12
  :: else ->
     if
     :: last[p] && seat[p] && (!accounted[p] || BUG == 8) -> lost[p]++
     :: else
     fi;
     state[p] = freed
  fi
}

/* From the publisher that was closed last to the one that was closed first. */
inline sweep() {
  s_at = closings;
  s_kept = 0;
  do
  :: s_at > 0 ->
     s_p = 0;
     do
     :: s_p < PUBLISHERS && closed_at[s_p] != s_at -> s_p++
     :: else -> break
     od;
     if
     :: s_p < PUBLISHERS && state[s_p] == closed && wants(s_p) &&
        (BUG == 1 || (BUG == 2 -> ended == s_at : s_kept < DEPTH)) -> s_kept++
     :: s_p < PUBLISHERS && state[s_p] == closed && wants(s_p) &&
        !(BUG == 1 || (BUG == 2 -> ended == s_at : s_kept < DEPTH)) ->
        assert(s_kept >= DEPTH);                         /* the newest stay */
        cut[s_p] = 1;
        try_to_free(s_p)
     :: s_p < PUBLISHERS && is_orphan(s_p) && !(state[s_p] == closed && wants(s_p)) ->
        try_to_free(s_p)
     :: else
     fi;
     s_at--
  :: else -> break
  od;
  assert(s_kept <= DEPTH);
  s_p = 0
}

/* A reader of the history may have read all of it already, without a seat. */
inline give_seat(p) {
  seat[p] = 1;
  accounted[p] = (HISTORY && last[p] && BUG != 16)
}

inline tell() {
  if
  :: BUG != 3 && wants(p) -> resync = true
  :: else
  fi
}

inline close(p) {
  d_step {
    closings++;
    closed_at[p] = closings;
    read_back[p] = HISTORY && subscription_lives && last[p];
    if
    :: HISTORY && BUG != 10 && subscription_lives && last[p] && !seat[p] -> give_seat(p)
    :: else
    fi;
#if BUG == 4
    tell();
    state[p] = moving
  };
  d_step {
    state[p] = closed;
#else
    state[p] = closed;
    tell();
#endif
    sweep();
    ended++
  }
}

inline refresh(p) {
  knows = subscription_lives;
  if
  :: knows && !BY_READER && !seat[p] -> give_seat(p)
  :: else
  fi
}

inline push(p) {
  if
  :: full(queue) -> queue?_
  :: nfull(queue)
  fi;
  queue!p
}

proctype Publisher(byte p) {
  bool knows;
  byte s_at, s_p, s_kept;
  if
  :: true -> d_step { refresh(p); known[p] = knows; owed[p] = knows };
     if
     :: true ->
        atomic { last[p] = 1; owed[p] = owed[p] || (subscription_lives && !HISTORY) };
        if
        :: true ->
           d_step { refresh(p); known[p] = (BUG == 7 -> knows : known[p]) };
           if
           :: true ->
              atomic {
                if
                :: knows && subscription_lives -> push(p)
                :: !(knows && subscription_lives)
                fi;
                completed[p] = 1
              }
           :: true /* killed */
           fi
        :: true /* killed */
        fi
     :: true /* killed */
     fi
  :: true /* killed */
  fi;
  close(p)
}

/* The reaper looks when it is told. */
proctype Reaper() {
  byte s_at, s_p, s_kept;
  do
  :: d_step { told -> told = false; sweep() }
  :: atomic { ended == PUBLISHERS && subscription_ended && !told -> break }
  od
}

inline end_look(p) {
  reading = none;
  if
  :: state[p] == freeing && BUG != 9 -> told = true
  :: else
  fi
}

/* Takes the message if it is new. */
inline look(p) {
  reading = p;
  if
  :: has_memory(p) || BUG == 13 ->
     atomic {
       assert(state[p] != freed);
       if
       :: last[p] && !noted[p] && (seat[p] || HISTORY || BY_READER) ->
          noted[p] = 1;
          delivered[p]++;
          seat[p] = (BY_READER -> 1 : seat[p])
       :: else
       fi
     };
     atomic {
       assert(state[p] != freed);
       if
       :: seat[p] && noted[p] ->
          accounted[p] = 1;
          taken[p] = 1;
          told = told || (state[p] == closed && BUG != 14)
       :: else
       fi
     }
  :: else
  fi;
  end_look(p)
}

/* All are looked at, whether the seat says that something is new or not: the history has none. */
inline look_at_everything() {
  atomic {
    resync = false;
    do
    :: queue?_
    :: empty(queue) -> break
    od;
    q = 0
  };
  do
  :: q < PUBLISHERS ->
     if
     :: (BUG != 4 && state[q] != freed) || (BUG == 4 && state[q] == live) -> look(q)
     :: else
     fi;
     q++
  :: q == PUBLISHERS -> break
  od;
#if BUG == 4
  q = 0;
  do
  :: q < PUBLISHERS ->
     if
     :: state[q] == closed -> look(q)
     :: else
     fi;
     q++
  :: q == PUBLISHERS -> break
  od;
#endif
  q = 0
}

#define all_is_quiet (ended == PUBLISHERS && !resync && empty(queue) && !told)

/* Created at any time, then takes or stands still. */
proctype Subscription() {
  byte q;
  bit noted[PUBLISHERS];
  {
    atomic { subscription_lives = true; resync = HISTORY };
    do
    :: resync -> look_at_everything()
    :: !resync && nempty(queue) -> queue?q; look(q); q = 0
    :: atomic { all_is_quiet || leaves -> break }
    od
  } unless { killed };
  has_stopped = true
}

/* The subscription closes between two takes or is killed at any step, or neither. The owner of the
 * registry lock closes its row and sweeps the topic. */
proctype Closer() {
  byte s_at, s_p, s_kept;
  subscription_lives;
  if
  :: leaves = true
  :: killed = true
  :: atomic { all_is_quiet && has_stopped -> goto ended_by_itself }
  fi;
  d_step {
    has_stopped ->
    subscription_lives = false;
    if
    :: BUG != 11 -> sweep()
    :: else
    fi
  };
ended_by_itself:
  subscription_ended = true
}

init {
  byte p;
  atomic {
    run Publisher(0); run Publisher(1); run Subscription(); run Closer();
    run Reaper()
  };
  _nr_pr == 1;
  for (p : 0 .. PUBLISHERS - 1) {
    assert(state[p] == freed);
    assert(killed || delivered[p] + lost[p] <= 1);
    assert(cut[p] || leaves || killed || lost[p] == 0);
    assert(cut[p] || leaves || killed || !read_back[p] || delivered[p] == 1);
    assert(leaves || killed || !completed[p] || !owed[p] || delivered[p] + lost[p] == 1)
  }
}
