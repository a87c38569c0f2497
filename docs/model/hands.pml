/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: a block of SMEM that is being made or given back stands in a *hand* of its process. Does
 * it belong to one process at a time, is it accessed only while it is backed with memory, and is it
 * free in the end, whichever process dies at whatever step, although /dev/shm may be full?
 *
 * Make: under the registry lock, reserve the block and take it into the hand. Without the lock, back
 * it. Under the lock, store it where it belongs, then empty the hand. Give back: under the lock, take
 * it into the hand, then clear the place. Without the lock, punch the hole. Under the lock, clear the
 * map, then empty the hand. So a block moves by two stores, both under the lock: a repair after the
 * death of its owner marks places first, then hands, and empties a hand whose block is marked. The
 * reapers of a dead process move what its hand and its places hold into their own hand, and give
 * it back; one of them may be killed, too. The SMEM has one block. The registry lock orders all
 * stores.
 *
 * BUG 1: backed with the registry lock held
 * BUG 2: a repair does not look at hands
 * BUG 3: the reaper does not look at the hand
 * BUG 4: the hand is filled after the lock is released
 * BUG 5: a block that cannot be backed is not given back
 * BUG 6: in its place before it is backed
 * BUG 7: the map is cleared before the hole is punched
 * BUG 8: the reaper does not wait until a killed process has stopped
 * BUG 9: the hand is emptied before the block is in its place
 * BUG 10: the place is cleared before the hand is filled
 * BUG 11: a repair leaves a block in two hands, or in a hand and its place
 * BUG 12: the reaper punches the hole from the dead process's hand, not from its own
 */
#define KILLED 1          /* the process that may be killed */
#define OTHER 2
#define REAPER 3
#define NEXT_REAPER 4
#define none 0

byte lock;                /* its owner */
bool owner_died;
bool used;                /* granule map of the one block: derived */
bool backed;
bool hand[5];             /* holds the block */
bool place[3];            /* an entry of the process leads to the block */
bool killed, dead, kill_reaper, reaper_dead, has_reaped;

inline mark_hand(p) {
  if
  :: hand[p] && used && BUG != 11 -> hand[p] = false
  :: hand[p] && (!used || BUG == 11) && BUG != 2 -> used = true
  :: else
  fi
}

inline repair() {
  d_step {
    used = place[KILLED] || place[OTHER];
    mark_hand(KILLED);
    mark_hand(OTHER);
    mark_hand(REAPER);
    mark_hand(NEXT_REAPER)
  }
}

inline take_lock(p) {
  atomic {
    lock == none -> lock = p;
    if
    :: owner_died -> repair(); owner_died = false
    :: else
    fi
  }
}

inline release_lock() {
  lock = none
}

#define holds(p) (hand[p] || place[p])

/* Any access to the block. */
inline touch(p) {
  assert(place[p] && backed && !holds(KILLED + OTHER - p))
}

inline make(p) {
  take_lock(p);
  if
  :: used -> release_lock()                              /* refused (no_space) */
  :: !used ->
     used = true;
#if BUG == 4
     release_lock();
     hand[p] = true;
#else
     hand[p] = true;
#if BUG != 1
     release_lock();
#endif
#endif
#if BUG == 6
     place[p] = true;
#endif
     if
     :: atomic { assert(lock != p); backed = true };
#if BUG == 1
        release_lock();
#endif
        take_lock(p);
#if BUG == 9
        hand[p] = false;
        place[p] = true;
#else
        place[p] = true;
        hand[p] = false;
#endif
        release_lock()
     :: atomic { assert(lock != p); is_full = true };    /* /dev/shm */
#if BUG == 1
        release_lock();
#endif
        if
        :: BUG != 5 -> empty_hand(p, p)
        :: else
        fi
     fi
  fi
}

/* Punches the hole and clears the map: of the block in the hand of `whose`. */
inline empty_hand(whose, by) {
#if BUG == 7
  take_lock(by);
  used = false;
  hand[whose] = false;
  release_lock();
  backed = false
#else
  backed = false;
  take_lock(by);
  used = false;
  hand[whose] = false;
  release_lock()
#endif
}

/* Takes the block of `whose` into the hand of `by`, and gives it back. */
inline give_back(whose, by) {
  take_lock(by);
  if
  :: place[whose] ->
#if BUG == 10
     place[whose] = false;
     hand[by] = true;
#else
     hand[by] = true;
     place[whose] = false;
#endif
     release_lock();
     empty_hand(by, by)
  :: else -> release_lock()
  fi
}

proctype Process(byte p) {
  bool is_full;
  {
    make(p);
    if
    :: place[p] -> touch(p); give_back(p, p)
    :: else
    fi
  } unless { p == KILLED && killed };
  atomic {
    dead = dead || p == KILLED;
    if
    :: p == KILLED && lock == KILLED -> lock = none; owner_died = true
    :: else
    fi
  }
}

/* Moves what is in a dead process's hand into its own, and gives it back. */
inline reap_hand(whose, by) {
  take_lock(by);
  if
  :: hand[whose] && BUG != 3 ->
#if BUG == 12
     release_lock();
     empty_hand(whose, by)
#else
     hand[by] = true;
     hand[whose] = false;
     release_lock();
     empty_hand(by, by)
#endif
  :: else -> release_lock()
  fi
}

/* SIGKILL of the process at any step, or never. */
proctype Reaper() {
  if
  ::
#if BUG != 8
     killed = true;
     dead;
#endif
     {
       reap_hand(KILLED, REAPER);
       give_back(KILLED, REAPER)
     } unless { kill_reaper };
     killed = true;
     atomic {
       reaper_dead = kill_reaper;
       if
       :: lock == REAPER -> lock = none; owner_died = true
       :: else
       fi
     }
  :: skip
  fi;
  has_reaped = true
}

/* The reaper of another cluster, at the same time or for what the first one left. */
proctype NextReaper() {
  if
  :: dead -> reap_hand(KILLED, NEXT_REAPER); give_back(KILLED, NEXT_REAPER)
  :: has_reaped
  fi;
  has_reaped;
  if
  :: reaper_dead -> reap_hand(REAPER, NEXT_REAPER)
  :: else
  fi;
  if
  :: killed -> dead; reap_hand(KILLED, NEXT_REAPER); give_back(KILLED, NEXT_REAPER)
  :: else
  fi
}

proctype Killer() {
  if
  :: kill_reaper = true
  :: skip
  fi
}

init {
  atomic { run Process(KILLED); run Process(OTHER); run Reaper(); run NextReaper();
    run Killer() };
  _nr_pr == 1;
  if
  :: owner_died -> repair(); owner_died = false          /* done by the next owner */
  :: else
  fi;
  assert(!used && !backed && !place[KILLED] && !place[OTHER]);
  assert(!hand[KILLED] && !hand[OTHER] && !hand[REAPER] && !hand[NEXT_REAPER])
}
