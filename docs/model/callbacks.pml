/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: is each message reported to its callback, though a publisher of the same context spares
 * the thread that calls callbacks, and never waits, and the thread looks only at what is marked?
 * Does a thread that holds a lock of the user destroy an entity, while another one's callback waits
 * for that lock, and does no callback run that was cleared, nor two at the same time? Does the
 * thread end when it is told to?
 *
 * Follows Outbox::publish, WakeWords::mark_arrival, CallbackMarks, CallbackThread::spared, ::report,
 * ::run, ::stop and ::remove, and Callback::set, with publishers, the thread, and one that sets the
 * callback meanwhile. What they share is guarded by a mutex or changed by locked instructions, so
 * store buffers are not modelled. A callback may publish itself, and a subscription may need a look
 * that would wait for another thread.
 * ELSEWHERE=1: the publishers' process has no callback in sight.
 * OTHER=1: the callback is replaced, too; it takes a lock of the user, and a further thread that
 * holds this lock destroys another entity.
 *
 * RUN PUBLISHERS=2 MESSAGES=1 OTHER=0 ELSEWHERE=0 (long)
 * RUN PUBLISHERS=1 MESSAGES=1 OTHER=1 ELSEWHERE=0 (long)
 * RUN PUBLISHERS=1 MESSAGES=2 OTHER=0 ELSEWHERE=1
 * RUN PUBLISHERS=2 MESSAGES=2 OTHER=0 ELSEWHERE=0 (long)
 *
 * BUG 1: a publisher that does not get its turn leaves it at that
 * BUG 2: the thread reads the epoch after it has looked
 * BUG 3 PUBLISHERS=1 MESSAGES=2 OTHER=0 ELSEWHERE=1: the word is spared though no callback was in sight
 * BUG 4: a message that a callback publishes is not left to the thread
 * BUG 5: a look that would wait is not left to the thread
 * BUG 6 PUBLISHERS=1 MESSAGES=2 OTHER=0 ELSEWHERE=1: watchers added after the thread has looked
 * BUG 7 PUBLISHERS=1 MESSAGES=2 OTHER=0 ELSEWHERE=1: the epoch raised before the mark
 * BUG 8: the thread takes the marks before it reads the epoch
 * BUG 9: what a publisher leaves to the thread is not marked
 * BUG 10 (reversed): a callback that is set anew is not looked at until it is marked
 * BUG 11 PUBLISHERS=1 MESSAGES=1 OTHER=1 ELSEWHERE=0 (reversed): a thread that clears a callback waits for its turn
 * BUG 12 PUBLISHERS=1 MESSAGES=1 OTHER=1 ELSEWHERE=0: a callback cleared without its mutex
 * BUG 13 PUBLISHERS=1 MESSAGES=1 OTHER=1 ELSEWHERE=0: earlier messages reported without the turn
 * BUG 14: the thread reads the epoch after it has released the lists
 */

bool turn;               /* CallbackThread::turn_ */
bool locked;             /* the mutex of the callback */
bool is_set;             /* the callback; guarded by its mutex */
bool lists;              /* CallbackThread::mutex_, which guards the next four */
bool is_listed;
bool is_another_listed;  /* so the thread runs already */
bool changed;            /* the lists, since the thread looked */
bool stopping;
bool in_sight;           /* whether the bucket of the topic has some callback */
bool watched;            /* whether the subscription's watchers have the thread's word */
bool marked;             /* the subscription */
bool left;               /* by a publisher to the thread */
byte epoch;
byte arrived, reported;
byte by_callback = 1;    /* messages that the callback will publish */
byte finished;
byte running;            /* callbacks */

bool users;              /* a lock of the user */
bool other_locked, other_is_set, in_other;  /* the other entity's callback */

inline lock(mutex) { atomic { !mutex -> mutex = true } }

inline raise_epoch() { epoch++ }

inline leave() {
#if BUG != 9
  left = true;
#endif
  raise_epoch()
}

inline take_lock_of_user() {
#if OTHER
  lock(users);
  users = false
#else
  skip
#endif
}

/* With the mutex of the callback. */
inline look() {
  n = arrived;
  if
  :: n > reported ->
    reported = n;
    d_step { running++; assert(running == 1) };
    take_lock_of_user();
    if
    :: atomic { by_callback > 0 -> by_callback--; arrived++ };
#if BUG != 4
      leave()
#endif
    :: true
    fi;
    running--
  :: else
  fi;
  n = 0
}

inline report_or_leave() {
  is_done = true;
  if
  :: atomic { !turn -> turn = true };
    if
    :: is_listed ->
      if
      :: atomic { !locked -> locked = true };
        if
        :: is_set -> look()
        :: is_set -> is_done = (BUG == 5)   /* would wait */
        :: else
        fi;
        locked = false
      :: locked -> is_done = false
      fi
    :: !is_listed
    fi;
    turn = false
  :: turn -> is_done = (BUG == 1)
  fi;
  if
  :: is_done -> is_done = false
  :: else -> leave()
  fi
}

proctype publisher() {
  byte n, sent;
  bool spares, is_done;
  do
  :: sent < MESSAGES ->
    spares = in_sight && !ELSEWHERE;
    arrived++;
    if
    :: spares -> report_or_leave()
#if BUG == 3
    :: else
#else
    :: !spares && watched ->
#if BUG == 7
       raise_epoch();
       marked = true
#else
       marked = true;
       raise_epoch()
#endif
    :: !spares && !watched
#endif
    fi;
    atomic { sent++; spares = false }
  :: else -> break
  od;
  finished++
}

inline add() {
  in_sight = true;
  lock(lists);
  d_step { is_listed = true; changed = true };
  raise_epoch();
  lists = false
}

inline look_at_all() {
  lock(lists);
  changed = true;
  raise_epoch();
  lists = false
}

inline stop() {
  lock(lists);
  stopping = true;
  raise_epoch();
  lists = false
}

inline set() {
#if BUG == 13
  has_turn = false;
#else
  atomic { has_turn = !turn; turn = true };
#endif
  lock(locked);
  if
  :: !is_listed -> add()
  :: is_listed
  fi;
  is_set = true;
#if BUG == 13
  look();
#else
  if
  :: has_turn -> look()
  :: else -> look_at_all()
  fi;
#endif
  locked = false;
  turn = turn && !has_turn
}

proctype setter() {
  byte n;
  bool has_turn;
  set();
#if OTHER
  set();                 /* replaces the callback */
#endif
  finished++
}

/* A thread that holds a lock of the user. */
proctype destroyer() {
  lock(users);
#if BUG == 11
  lock(turn);
#elif BUG != 12
  lock(other_locked);
#endif
  other_is_set = false;
#if BUG == 11
  turn = false;
#elif BUG != 12
  other_locked = false;
#endif
  assert(!in_other);
  users = false;
  finished++
}

/* Each is an exchange of its own. */
inline take_marks() {
  d_step { is_marked = is_marked || marked; marked = false };
  d_step { is_marked = is_marked || left; left = false }
}

inline look_at_marked() {
  lock(turn);
  if
  :: is_marked ->
    lock(locked);
    if
    :: is_set -> look()
    :: else
    fi;
    locked = false
  :: else
  fi;
#if OTHER
  lock(other_locked);
  if
  :: other_is_set ->
     d_step { running++; assert(running == 1); in_other = true };
     d_step { running--; in_other = false }
  :: else
  fi;
  other_locked = false;
#endif
  turn = false
}

proctype thread() {
  byte n, seen;
  bool is_marked, is_new;
again:
  atomic { (is_listed || is_another_listed || stopping) && !lists -> lists = true };
  if
  :: stopping -> lists = false; goto ended
  :: else
  fi;
  d_step { is_new = changed; changed = false };
#if BUG != 6
  watched = watched || is_new;
#endif
#if BUG != 10
  is_marked = is_new;
#endif
#if BUG != 6
  is_new = false;
#endif
#if BUG == 14
  lists = false;
  seen = epoch;
#elif BUG != 2 && BUG != 8
  seen = epoch;
  lists = false;
#else
  lists = false;
#endif
  take_marks();
#if BUG == 8
  seen = epoch;
#endif
  look_at_marked();
#if BUG == 2
  seen = epoch;
#endif
#if BUG == 6
  watched = watched || is_new;
#endif
  is_marked = false;
  epoch != seen;
  goto again;
ended:
  skip
}

init {
  bool is_stopped_asleep;
  if
  :: d_step { in_sight = true; is_another_listed = true }  /* of the same bucket */
  :: true
  fi;
  atomic {
    other_is_set = OTHER;
    run publisher();
    if
    :: PUBLISHERS == 2 -> run publisher()
    :: else
    fi;
    run setter();
    run thread();
    if
    :: OTHER -> run destroyer()
    :: else
    fi
  };
  finished == PUBLISHERS + 1 + OTHER;
  if
  :: is_stopped_asleep = true
  :: true
  fi;
  if
  :: is_stopped_asleep -> timeout -> assert(reported == arrived)
  :: else
  fi;
  stop()
}
