/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: does SMEM that a publisher takes for a generation under the registry lock, and backs
 * with memory without it, belong to one publisher at a time, is it touched only while memory is
 * behind it, and is it given back in the end, whoever dies where and although /dev/shm may be full?
 *
 * Follows TopicDsmWriter (add_generation, open_generation, free_old_generations), Generation
 * (reserve, open, free), Registry::repair and freeing.cpp (sweep_publisher). The SMEM has room for
 * one generation, which two publishers want; the first may be killed at any step, and is then
 * reaped. Every store here is ordered by the lock or by a system call, but for that of `first`,
 * which x86 keeps behind the stores before it.
 *
 * BUG 1: memory backed with the registry lock held
 * BUG 2: a repairer of the registry goes by first
 * BUG 3: the reaper goes by first
 * BUG 4: offset stored after the lock is released
 * BUG 5: SMEM that cannot be backed is not given back
 * BUG 6: first stored before the memory is there
 * BUG 7: offset cleared before the memory is given back
 * BUG 8: the reaper does not wait until a killed process takes no more steps
 * BUG 9: memory given back after the SMEM, without the lock
 */
#define KILLED 1          /* the publisher that may be */
#define OTHER 2
#define REAPER 3
#define nobody 0

byte lock;                /* who holds it */
bool owner_died;
bool used;                /* the granule map: derived from the entries */
bool offset[3];           /* of the publishers' entries, indexed by publisher */
bool first[3];
bool backed;              /* memory is behind the SMEM */
bool killed, dead;

inline repair() {
#if BUG == 2
  used = first[KILLED] || first[OTHER]
#else
  used = offset[KILLED] || offset[OTHER]
#endif
}

inline take_lock(p) {
  atomic {
    lock == nobody -> lock = p;
    if
    :: owner_died -> owner_died = false; repair()
    :: else
    fi
  }
}

inline release_lock() {
  lock = nobody
}

/* Any read or write of descriptors or bytes. */
inline touch(p) {
  assert(backed && offset[p])
}

inline reserve(p) {
  used = true;
#if BUG == 4
  release_lock();
  offset[p] = true;
#else
  offset[p] = true;
#if BUG != 1
  release_lock();
#endif
#endif
  assert(!offset[KILLED] || !offset[OTHER])
}

inline open(p) {
#if BUG == 6
  first[p] = true;
#endif
  atomic {
    assert(lock != p);
    if
    :: backed = true
    :: no_space = true; backed = true                    /* a part; then /dev/shm is full */
    fi
  };
  if
  :: !no_space -> touch(p); first[p] = true; touch(p)
  :: no_space
  fi
}

inline free(p) {
#if BUG == 7
  offset[p] = false;
#endif
  used = false;
  backed = false;
#if BUG != 7
  offset[p] = false
#endif
}

proctype Publisher(byte p) {
  bool no_space;
  {
    take_lock(p);
    if
    :: !used ->
       reserve(p);
       open(p);
       if
       :: no_space && BUG == 5
       :: else ->
          first[p] = false;
          if
          :: !no_space && BUG != 9 -> backed = false
          :: else
          fi;
          take_lock(p);
          free(p);
          release_lock();
#if BUG == 9
          backed = false
#endif
       fi
    :: used -> release_lock()                            /* refused (no_space) */
    fi
  } unless { p == KILLED && killed };
  atomic {
    dead = dead || p == KILLED;
    if
    :: p == KILLED && lock == KILLED -> lock = nobody; owner_died = true
    :: else
    fi
  }
}

proctype Reader() {
  do
  :: atomic { first[OTHER] -> assert(backed) }
  :: break
  od
}

/* SIGKILL at any step, or never. */
proctype Reaper() {
  if
  ::
#if BUG != 8
     killed = true;
     dead;
#endif
     take_lock(REAPER);
     if
#if BUG == 3
     :: first[KILLED] -> free(KILLED)
#else
     :: offset[KILLED] -> free(KILLED)
#endif
     :: else
     fi;
     release_lock();
     killed = true
  :: skip
  fi
}

init {
  atomic { run Publisher(KILLED); run Publisher(OTHER); run Reader(); run Reaper() };
  _nr_pr == 1;
  assert(!used && !backed && !offset[KILLED] && !offset[OTHER])
}
