/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: is the memory of a subscription freed only when no publisher and no receive thread can
 * still push to it, and is it always freed in the end, although they are killed?
 *
 * Follows closing.cpp (close), freeing.cpp (free_subscription), TopicDsmWriter::enter and ::leave,
 * ReceiveThread::forward. The publisher pushes through its private reader list; the
 * receive thread reads the table each time. The publisher may be killed at any step and is then
 * reaped. So may the receive thread, which is replaced if its cluster has a process left. The
 * process that closes the subscription may be killed at any step as well. The next owner of the
 * registry lock then frees closed endpoints, continuing where the dead process stopped: a publisher
 * seen outside its phase is not checked again. Endpoints not closed yet are closed by the reaper,
 * which may get the lock later.
 *
 * BUG 1: freed without waiting for the phases
 * BUG 2: publisher: no fence between phase and the load of match_generation
 * BUG 3: publisher refreshes its list before its phase is odd
 * BUG 4: receive thread: no fence between phase and the load of the table
 * BUG 5: phases checked before the reader is removed from the table
 * BUG 6: match_generation not incremented
 * BUG 7: reaper does not end the phase of a killed publisher
 * BUG 8: a new receive thread does not end the phase of its predecessor
 * BUG 9: publisher's phase is even before its last push
 * BUG 10: the sweeper waits for a dead receive thread that has no successor
 * BUG 11: a receive thread counts as dead once its lifeline ends, not once it has stopped
 * BUG 12: an endpoint that a killed process closed in part is freed as if it were closed
 * BUG 13 (reversed): closed before the reader is removed from the table
 * BUG 14 (reversed): a publisher recorded as seen out before it was checked
 * BUG 15: the publisher's phase noted before the reader is removed from the table
 */
#define GENERATION 0      /* match_generation */
#define ACTIVE 1          /* of the reader table's entry */
#define PHASE(p) (2 + (p))
#define WORDS 4
#define PROCESSES 3
#define PUBLISHER 0
#define RECEIVER 1
#define CLOSER 2
#define MESSAGES 2

#include "tso.pml"

bool closed;               /* state of the subscription; while false, it is closing */
bool swept;                /* the one source is free */
byte noted;                /* SourceEntry::accounted: the publisher's phase when it lost its reader */
bool freed;
bool kill_publisher, kill_receiver, kill_closer;
bool publisher_ended, receiver_ended, closer_ended;
bool receiver_lives = true;    /* its lifeline is held */

inline enter(p) {
  if
  :: BUG == 2 + 2 * p -> store_release(p, PHASE(p), 2 * message - 1)
  :: else -> store_seq_cst(p, PHASE(p), 2 * message - 1)
  fi
}

inline leave(p) {
  store_release(p, PHASE(p), 2 * message)
}

#define is_out(p) (load(CLOSER, PHASE(p)) % 2 == 0)
/* A phase that began later began with a look at match_generation. */
#define has_looked (is_out(PUBLISHER) || load(CLOSER, PHASE(PUBLISHER)) != noted)

/* Each step inside a push accesses the queue; one step stands for all. */
inline push() {
  assert(!freed)
}

inline refresh() {
  if
  :: load(PUBLISHER, GENERATION) != seen ->
     seen = load(PUBLISHER, GENERATION);
     listed = load(PUBLISHER, ACTIVE)
  :: else
  fi
}

proctype Publisher() {
  byte seen, message;
  bool listed = true;      /* the match was made before */
  {
    do
    :: message < MESSAGES ->
       message++;
#if BUG == 3
       refresh();
#endif
       enter(PUBLISHER);
#if BUG != 3
       refresh();
#endif
#if BUG == 9
       leave(PUBLISHER);
#endif
       if
       :: listed -> push()
       :: else
       fi;
#if BUG != 9
       leave(PUBLISHER)
#endif
    :: break              /* silent forever */
    od
  } unless { kill_publisher };
  publisher_ended = true
}

proctype ReceiveThread() {
  byte message;
  {
    do
    :: message < MESSAGES ->
       message++;
       enter(RECEIVER);
       if
       :: load(RECEIVER, ACTIVE) -> push()
       :: else
       fi;
       leave(RECEIVER)
    :: break              /* silent forever */
    od
  } unless { kill_receiver };
  receiver_ended = true
}

/* Kills and reaps, or not. A dead process executes no steps, but its stores still become visible.
 * */
proctype Reaper() {
  if
  :: kill_publisher = true;
     publisher_ended && settled(PUBLISHER);
#if BUG != 7
     memory[PHASE(PUBLISHER)] = 0
#endif
  :: skip
  fi
}

proctype Successor() {
  if
  ::
#if BUG == 11
     receiver_lives = false;
#endif
     kill_receiver = true;
     receiver_ended && settled(RECEIVER);
     receiver_lives = false;
     if
     :: receiver_lives = true;
#if BUG != 8
        memory[PHASE(RECEIVER)] = 0;
#endif
        kill_receiver = false;
        run ReceiveThread()
     :: skip               /* the cluster has no process left */
     fi
  :: skip
  fi
}

inline wait_for_receive_thread() {
#if BUG == 10
  is_out(RECEIVER)
#else
  is_out(RECEIVER) || !receiver_lives
#endif
}

inline take_off() {
#if BUG == 15
  noted = load(CLOSER, PHASE(PUBLISHER));
#endif
  store_release(CLOSER, ACTIVE, 0);
#if BUG != 6
  d_step { settled(CLOSER) -> memory[GENERATION]++ };
#else
  settled(CLOSER);
#endif
#if BUG != 15
  noted = load(CLOSER, PHASE(PUBLISHER))
#endif
}

inline free_when_out() {
#if BUG != 1 && BUG != 5
  if
#if BUG == 14
  :: !swept -> swept = true; has_looked
#else
  :: !swept -> has_looked; swept = true
#endif
  :: else
  fi;
  wait_for_receive_thread();
#endif
  freed = true
}

/* Runs under the registry lock; repeated whenever the lock is taken. */
proctype Closer() {
  {
#if BUG == 5
    is_out(PUBLISHER);
    wait_for_receive_thread();
#endif
#if BUG == 13
    closed = true;
#endif
    take_off();
    closed = true;
    free_when_out()
  } unless { kill_closer };
  closer_ended = true
}

/* Kills the closer, or not. Runs the next owner of the registry lock, which may not know yet that
 * the closer is dead, and after it the reaper, which closes once more. */
proctype NextOwners() {
  if
  :: kill_closer = true;
     closer_ended && settled(CLOSER);
     if
#if BUG == 12
     :: true -> free_when_out()
#endif
     :: closed -> free_when_out()
     :: else -> take_off(); closed = true; free_when_out()
     fi
  :: skip
  fi
}

/* A phase that stays odd forever keeps Closer from its end: spin reports an invalid end state. */
init {
  atomic {
    memory[ACTIVE] = 1;
    run StoreBuffer(PUBLISHER); run StoreBuffer(RECEIVER); run StoreBuffer(CLOSER);
    run Publisher(); run ReceiveThread(); run Reaper(); run Successor(); run Closer(); run NextOwners()
  }
}
