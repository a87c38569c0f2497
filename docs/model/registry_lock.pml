/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: does the registry lock have one owner at a time, and does the next owner learn of one
 * that died, though threads of different PID namespaces have the same number and are killed between
 * any two stores? Does each thread that survives get the lock?
 *
 * Follows RecoverableMutex::lock and unlock, RegistryMutex and the robust mutexes of glibc and the
 * kernel: a thread notes a mutex as pending, stores its number into it, and lists it; when the thread
 * ends, the kernel clears each of its listed and pending mutexes that holds its number.
 *
 * Badge 0 is that of process 0, whose threads have the numbers 1 and 2, and after it was reaped that
 * of process 2, whose threads have the numbers 2 and, with TWO=1, 3. Process 1, number 1, has badge 1,
 * and reaps. Process 0 is killed at any step: its threads stop, the one that holds its line too, and
 * end later, in any order. With GUEST=1 badge 0 is the guest badge: it has no line, and processes 0 and
 * 2, number 1 each, hold it under a lock of the file, which the kernel releases when a process has
 * ended. A waiting thread re-checks the owner, so no wake-up is modelled. Memory is sequentially
 * consistent: each store on which another thread relies is a locked instruction.
 *
 * RUN GUEST=0 TWO=0 (long)
 * RUN GUEST=1 TWO=0
 * RUN GUEST=0 TWO=1 (long)
 * BUG 1: all take the lock from one badge, so the badge is the lock, as a plain robust mutex is
 * BUG 2: a lock whose owner has ended is taken over by a store
 * BUG 3 GUEST=1 TWO=0: a ticket names the badge alone
 * BUG 4: an owner is judged by its line alone
 * BUG 5 (reversed): an owner is judged by its badge alone
 * BUG 6 GUEST=1 TWO=0: a ticket of a predecessor in the own badge is waited for
 * BUG 7 GUEST=1 TWO=0: the guest badge is held without the lock of the file
 * BUG 8 GUEST=1 TWO=0: the lock of the file is given back before the badge
 * BUG 9 GUEST=0 TWO=1 (reversed): threads of a process wait for each other with the badge, not before it
 */
#define THREADS 5
#define FIRST 0    /* process 0, number 1 */
#define SECOND 1   /* process 0, number 2 */
#define OTHER 2    /* process 1, number 1 */
#define NEXT 3     /* process 2, number 2, or 1 */
#define LAST 4     /* process 2, number 3 */

byte mark[2];              /* LockBadge::held: the number of the thread in it */
bool line[2];              /* held */
byte word;                 /* the ticket: 0, or badge + 1 + 2 * take */
byte takes[2];
byte pending[THREADS], listed[THREADS];  /* badge + 1 */
bool inside[THREADS];
bool is_killed;            /* process 0 */
byte owners;
bool broken;               /* an owner has died since the last repair */
bool is_freed;             /* slot 0 */
bool threads[2];           /* RegistryMutex::threads_ of process 0 and 2 */
byte guest;                /* thread + 1 that holds the lock of the file */

#define badge_of(ticket) ((ticket - 1) % 2)
#if BUG == 3
#define ticket_of(s) (s + 1)
#else
#define ticket_of(s) (s + 1 + 2 * takes[s])
#endif

/* What the kernel does when a thread ends. */
inline end_thread(t, number) {
  d_step {
    if
    :: listed[t] != 0 && mark[listed[t] - 1] == number -> mark[listed[t] - 1] = 0
    :: else
    fi;
    if
    :: pending[t] != 0 && mark[pending[t] - 1] == number -> mark[pending[t] - 1] = 0
    :: else
    fi;
    if
    :: inside[t] -> inside[t] = false; owners--; broken = true
    :: else
    fi;
    if
    :: guest == t + 1 -> guest = 0
    :: else
    fi
  }
}

inline hold(t, s, number) {
  pending[t] = s + 1;
  atomic { mark[s] == 0 -> mark[s] = number };
  listed[t] = s + 1;
  pending[t] = 0
}

inline give_badge_back(t, s) {
  pending[t] = s + 1;
  listed[t] = 0;
  mark[s] = 0;
  pending[t] = 0
}

#define IS_GUEST (GUEST && badge == 0)
#define own_threads threads[(t >= NEXT -> 1 : 0)]

/* Killed in between, a process needs its mutex no more. */
inline lock_threads(t) {
  if
  :: t != OTHER && BUG != 9 -> atomic { !own_threads -> own_threads = true }
  :: else
  fi
}

inline unlock_threads(t) {
  if
  :: t != OTHER -> own_threads = false
  :: else
  fi
}

inline lock_file(t) {
#if BUG != 7
  atomic { !IS_GUEST || guest == 0 -> guest = (IS_GUEST -> t + 1 : guest) }
#else
  skip
#endif
}

inline unlock_file(t) {
  d_step { guest = (guest == t + 1 -> 0 : guest) }
}

inline judge(ticket) {
  has_ended = false;
  if
  :: ticket == 0 -> has_ended = true
#if BUG != 6
  :: ticket != 0 && badge_of(ticket) == s -> has_ended = true
#endif
  :: else ->
#if BUG != 5 && BUG != 1
     if
     :: !line[badge_of(ticket)] ->
#endif
#if BUG == 4
     has_ended = true
#else
     has_ended = (mark[badge_of(ticket)] == 0)
#endif
#if BUG != 5 && BUG != 1
     :: else
     fi
#endif
  fi
}

inline take_lock(s) {
  takes[s]++;
  mine = ticket_of(s);
  is_owner = false;
  do
  :: !is_owner ->
     seen = word;
     judge(seen);
     if
     :: has_ended ->
#if BUG == 2
        word = mine;
        is_owner = true
#else
        atomic {
          if
          :: word == seen -> word = mine; is_owner = true
          :: else
          fi
        }
#endif
     :: else -> word != seen || (!line[badge_of(seen)] && mark[badge_of(seen)] == 0) || BUG == 1
     fi
  :: else -> break
  od;
  is_told = (seen != 0);
  seen = 0;
  has_ended = false
}

inline enter(t) {
  d_step {
    owners++;
    inside[t] = true;
    assert(owners == 1);
    assert(!broken || is_told);
    broken = false
  }
}

inline reap(t) {
  if
  :: t == OTHER && !GUEST && !line[0] -> is_freed = true
  :: else
  fi
}

inline leave(t, s) {
  d_step { inside[t] = false; owners-- };
  atomic {
    if
    :: word == mine -> word = 0
    :: else
    fi
  }
}

proctype Thread(byte t, badge, number, rounds) {
  byte s, seen, mine;
  bool is_owner, is_told, has_ended;
  {
#if BUG == 1
    s = 0;
#else
    s = badge;
#endif
    do
    :: rounds > 0 ->
       rounds--;
       lock_threads(t);
       lock_file(t);
       hold(t, s, number);
       take_lock(s);
       enter(t);
       reap(t);
       leave(t, s);
#if BUG == 8
       unlock_file(t);
#endif
       give_badge_back(t, s);
       unlock_file(t);
       unlock_threads(t)
    :: else -> break
    od
  } unless { is_killed && t <= SECOND -> end_thread(t, number) }
}

/* The kill, and the end of the thread that holds the line. */
proctype Killer() {
  is_killed = true;
  if
  :: !GUEST -> line[0] = false
  :: GUEST
  fi
}

proctype Successor() {
end:
  if
  :: is_freed -> line[0] = true
  :: GUEST
  fi;
  run Thread(NEXT, 0, (GUEST -> 1 : 2), 1);
  if
  :: TWO -> run Thread(LAST, 0, 3, 1)
  :: !TWO
  fi
}

init {
  atomic {
    line[0] = !GUEST;
    line[1] = true;
    run Thread(FIRST, 0, 1, 1);
    if
    :: !GUEST -> run Thread(SECOND, 0, 2, 1)
    :: else
    fi;
    run Thread(OTHER, 1, 1, 2);
    run Killer();
    run Successor()
  }
}
