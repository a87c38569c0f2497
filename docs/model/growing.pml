/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: SMEM for a generation is reserved under the registry lock and backed with memory
 * without it. Does it belong to one publisher at a time, is it accessed only while it is backed,
 * and is it freed in the end, whichever process dies at whatever step, although /dev/shm may be
 * full?
 *
 * Follows TopicDsmWriter (add_generation, open_generation, open_first_generation), Generation
 * (reserve, open) and Registry::repair. It is given back piece by piece here; hands.pml is the model
 * of how the code does that. The SMEM has two pieces. One publisher wants both; it may be killed at
 * any step, and is then reaped, and its reaper may be killed, too. The other publisher wants one
 * piece. Each store is ordered by the lock or by a system call, except that of `first`, which x86
 * does not reorder before earlier stores.
 *
 * BUG 1: memory backed with the registry lock held
 * BUG 2: a repairer of the registry uses first
 * BUG 3: the reaper uses first
 * BUG 4: offset stored after the lock is released
 * BUG 5: SMEM that cannot be backed is not freed
 * BUG 6: first stored before the memory is backed
 * BUG 7: the entry drops a piece before it is freed
 * BUG 8: the reaper does not wait until a killed process executes no more steps
 * BUG 9: the memory of a piece released after its SMEM is freed, without the lock
 * BUG 10: a repairer uses the initial size, not what is left
 * BUG 11: a piece freed without the lock
 */
#define KILLED 1          /* the publisher that may be killed */
#define OTHER 2
#define REAPER 3
#define none 0
#define PIECES 2

byte lock;                /* its owner */
bool owner_died;
bool used[PIECES];        /* the granule map: derived from the entries */
bool backed[PIECES];      /* with memory */
bool offset[3];           /* of the publishers' entries, by publisher: it holds SMEM */
byte begin[3], end[3];    /* the pieces that it holds: kept_pieces */
bool first[3];
bool killed, dead, kill_reaper;

#define has(p, i) (offset[p] && begin[p] <= (i) && (i) < end[p])
#if BUG == 2
#define is_known(p, i) (first[p] && has(p, i))
#elif BUG == 10
#define is_known(p, i) (offset[p] && (p == KILLED || begin[p] == (i)))
#else
#define is_known(p, i) has(p, i)
#endif

inline repair() {
  used[0] = is_known(KILLED, 0) || is_known(OTHER, 0);
  used[1] = is_known(KILLED, 1) || is_known(OTHER, 1)
}

inline take_lock(p) {
  atomic {
    lock == none -> lock = p;
    if
    :: owner_died -> owner_died = false; repair()
    :: else
    fi
  }
}

inline release_lock() {
  lock = none
}

#define is_whole(p, i) (!has(p, i) || backed[i])

/* Any access to descriptors or bytes. */
inline touch(p) {
  assert(offset[p] && is_whole(p, 0) && is_whole(p, 1))
}

inline reserve(p) {
  d_step {
    begin[p] = (p == OTHER && used[0] -> 1 : 0);
    end[p] = (p == OTHER -> begin[p] + 1 : PIECES);
    used[begin[p]] = true;
    used[end[p] - 1] = true
  };
#if BUG == 4
  release_lock();
  offset[p] = true;
#else
  offset[p] = true;
#if BUG != 1
  release_lock();
#endif
#endif
  assert(!(has(KILLED, 0) && has(OTHER, 0)) && !(has(KILLED, 1) && has(OTHER, 1)))
}

inline open(p) {
#if BUG == 6
  first[p] = true;
#endif
  atomic {
    assert(lock != p);
    backed[begin[p]] = true;
    if
    :: backed[end[p] - 1] = true
    :: no_space = true                                   /* /dev/shm is full */
    fi
  };
  if
  :: !no_space -> touch(p); first[p] = true; touch(p)
  :: no_space
  fi
}

/* Frees the last piece that a publisher holds. The caller holds the lock. */
inline free_some(whose) {
#if BUG == 7
  if
  :: end[whose] == begin[whose] + 1 -> offset[whose] = false; last = begin[whose]
  :: else -> end[whose]--; last = end[whose]
  fi;
  used[last] = false;
  backed[last] = false
#else
  last = end[whose] - 1;
  used[last] = false;
#if BUG == 9
  release_lock();
#endif
  backed[last] = false;
  if
  :: last == begin[whose] -> offset[whose] = false
  :: else -> end[whose] = last
  fi
#endif
}

inline free_all(whose, by) {
  do
#if BUG == 3
  :: (by == REAPER -> first[whose] : offset[whose]) ->
#else
  :: offset[whose] ->
#endif
#if BUG != 11
     take_lock(by);
#endif
     if
     :: offset[whose] -> free_some(whose)
     :: else
     fi;
#if BUG != 11 && BUG != 9
     release_lock()
#endif
  :: else -> break
  od
}

#define has_room(p) (p == OTHER -> !used[0] || !used[1] : !used[0] && !used[1])

proctype Publisher(byte p) {
  bool no_space;
  byte last;
  {
    take_lock(p);
    if
    :: has_room(p) ->
       reserve(p);
       open(p);
       if
       :: no_space && BUG == 5
       :: else -> first[p] = false; free_all(p, p)
       fi
    :: else -> release_lock()                            /* refused (no_space) */
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

proctype Reader() {
  do
  :: atomic { first[OTHER] -> assert(is_whole(OTHER, 0) && is_whole(OTHER, 1)) }
  :: break
  od
}

/* SIGKILL of the publisher at any step, or never. */
proctype Reaper() {
  byte last;
  if
  ::
#if BUG != 8
     killed = true;
     dead;
#endif
     { free_all(KILLED, REAPER) } unless { kill_reaper };
     atomic {
       if
       :: lock == REAPER -> lock = none; owner_died = true
       :: else
       fi
     };
     free_all(KILLED, REAPER);                           /* the next reaper, if it was killed */
     killed = true
  :: skip
  fi
}

proctype Killer() {
  if
  :: kill_reaper = true
  :: skip
  fi
}

init {
  atomic { run Publisher(KILLED); run Publisher(OTHER); run Reader(); run Reaper(); run Killer() };
  _nr_pr == 1;
  if
  :: owner_died -> owner_died = false; repair()          /* done by the next owner */
  :: else
  fi;
  assert(!used[0] && !used[1] && !backed[0] && !backed[1] && !offset[KILLED] && !offset[OTHER])
}
