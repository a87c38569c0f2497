/* Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
 *
 * Question: does virtual time advance only when nothing can happen at that time any more, do events
 * come in one order, and does a killed process not stop it?
 *
 * Follows Timekeeper::step, ProcessThreads::look, Member::wait_in and Waiter::wait_virtually. Node A
 * publishes at time 0 to node B of another cluster, whose main thread hands the message to its
 * worker threads: they wake each other three times, then the last one publishes to A and to B. A has
 * a timer at 2, B at 1. Worker threads have no seat. KILL=1: B is killed at any of its steps. The run
 * starts its successor, C, when it likes; C takes part once it has joined.
 *
 * RUN KILL=0
 * RUN KILL=1
 *
 * BUG 1: threads without a seat are not looked at
 * BUG 2: they are looked at once
 * BUG 3: the count of their turns on a CPU is not compared
 * BUG 4: the receive thread is not looked at
 * BUG 5: only the pipe of the receive thread is looked at
 * BUG 6: epoch read after the queue was checked
 * BUG 7: time advances to a due time without a look at wake words
 * BUG 8: a thread is let go while another one runs
 * BUG 9 KILL=1: a process that was let go is waited for though it died
 * BUG 10 KILL=1: the end of a process is not noted when its successor is started
 * BUG 11 KILL=1: time advances though a successor has not joined
 */
#define A 0
#define B 1
#define C 2
#define NONE 3
#define FOREVER 9
#define END 2
#define HOPS 3

mtype = { running, waiting, freed };
mtype seat[2] = waiting;  /* both wait to start, A first */
mtype seat_c = freed;
byte due[2], epoch[2], seen[2], queue[2];
byte now = 0;
byte pipe = 0;            /* messages to the receive thread of B's cluster */
bool forwards = false;    /* it has read one and not pushed it yet */
bool woken[2], runs[2];   /* workers of B */
byte turns[2], hops = 0;
byte turn = NONE, last = B;
bool dead = false, over = false;
bool ended = false;       /* time stands: the run has not started the successor yet */
bool starts = false;      /* it has, and the timekeeper has not heard of it */
bool awaits = false;      /* time stands: the successor has not joined */
bool has_joined = false;

#define is_awake(i) (woken[i] || runs[i])
#define is_quiet_world \
  ((dead || (!is_awake(0) && !is_awake(1))) && pipe == 0 && !forwards && queue[A] == 0 && (dead || queue[B] == 0))

/* In one step: what a process killed between the two had pushed, its reader finds when it looks
 * next. Raised later than pushed: waiting.pml. */
inline push(i) { d_step { queue[i]++; epoch[i]++ } }

inline wait_until(i, at) {
  due[i] = at;
  seat[i] = waiting;
  (seat[i] == running || over)
}

proctype NodeA() {
  (seat[A] == running);
  pipe++;                 /* write() wakes its reader before it returns */
  do
  :: over || now == END -> break
  :: else ->
     if
     :: BUG != 6 -> seen[A] = epoch[A]
     :: else
     fi;
     if
     :: queue[A] > 0 ->
        wait_until(A, now);
        assert(now == 0);
        queue[A]--
     :: queue[A] == 0 ->
        if
        :: BUG == 6 -> seen[A] = epoch[A]
        :: else
        fi;
        wait_until(A, END)
     fi
  od;
  seat[A] = freed
}

proctype NodeB() {
  byte message = 0;
  byte timer = 1;
  {
    (seat[B] == running);
    do
    :: over -> break
    :: else ->
       if
       :: BUG != 6 -> seen[B] = epoch[B]
       :: else
       fi;
       if
       :: queue[B] > 0 ->
          wait_until(B, now);
          if
          :: over -> break
          :: else
          fi;
          assert(now == 0);
          atomic { queue[B]--; message++ };
          if
          :: message == 1 -> woken[1] = true
          :: else
          fi
       :: queue[B] == 0 ->
          if
          :: BUG == 6 -> seen[B] = epoch[B]
          :: else
          fi;
          wait_until(B, timer);
          timer = (now >= timer -> FOREVER : timer)
       fi
    od
  } unless { dead }
}

proctype Worker(byte i) {
  {
    end:
    do
    :: over -> break
    :: atomic { woken[i] -> woken[i] = false; runs[i] = true; turns[i]++ };
       if
       :: hops < HOPS -> hops++; woken[1 - i] = true
       :: else -> push(A); push(B)
       fi;
       runs[i] = false
    od
  } unless { dead }
}

proctype ReceiveThread() {
  end:
  do
  :: over -> break
  :: pipe > 0 ->
     atomic { pipe--; forwards = true };
     if
     :: !dead -> push(B)
     :: dead
     fi;
     forwards = false
  od
}

proctype Killer() {
  end:
  if
  :: KILL == 1 && !over -> dead = true
  fi
}

proctype Successor() {
  seat_c = waiting;
  (seat_c == running || over);
  has_joined = true;
  seat_c = waiting;
  (over);
  seat_c = freed
}

proctype Run() {
  end:
  (dead);
  run Successor();
  starts = true
}

#define has_died(i) (i == B && dead)

inline look(which) {
  counts[which] = turns[which];
  slept = slept && !is_awake(which)
}

/* Of workers of B, which may run only at B's turn. */
inline settle_workers() {
  do
  :: BUG == 1 || turn != B || dead -> break
  :: else ->
     slept = true;
     look(0);
     look(1);
     if
     :: BUG == 2 || !slept -> skip
     :: else ->
        slept = slept && !is_awake(0) && (BUG == 3 || counts[0] == turns[0]);
        slept = slept && !is_awake(1) && (BUG == 3 || counts[1] == turns[1])
     fi;
     if
     :: slept -> break
     :: else
     fi
  od
}

#define is_ready(i) \
  (seat[i] == waiting && (due[i] <= now || (BUG != 7 && epoch[i] != seen[i] && has_begun[i])))

inline let_go(i) {
  atomic {
    assert(seat[1 - i] != running || has_died(1 - i));
    has_begun[i] = true;
    seat[i] = running;
    turn = i;
    last = turn
  }
}

proctype Timekeeper() {
  byte counts[2];
  bool slept;
  bool has_begun[2];
  byte next;
  do
  :: over -> break
  :: !over ->
     if
     :: turn != NONE ->
        if
        :: BUG == 8
        :: BUG != 8 && turn != C && seat[turn] != running
        :: turn == C && seat_c != running
        :: BUG != 9 && has_died(turn)
        fi;
        settle_workers();
        if
        :: BUG == 4
        :: BUG == 5 && pipe == 0
        :: BUG != 4 && BUG != 5 && pipe == 0 && !forwards
        fi;
        turn = NONE
     :: atomic {
          starts -> starts = false;
          ended = false;
          awaits = true;
          if
          :: BUG != 10 -> seat[B] = freed
          :: else
          fi
        }
     :: turn == NONE && !awaits && dead && seat[B] != freed -> seat[B] = freed; ended = true
     :: turn == NONE && awaits ->
        if
        :: seat_c == waiting -> awaits = false; seat_c = running; turn = C
        :: BUG == 10 && seat[B] == waiting -> awaits = false; seat[B] = running; turn = B
        fi
     :: turn == NONE && !(awaits && BUG != 11) && !ended && !(dead && seat[B] != freed) ->
        if
        :: is_ready((1 - last)) -> let_go((1 - last))
        :: !is_ready((1 - last)) && is_ready(last) -> let_go(last)
        :: !is_ready((1 - last)) && !is_ready(last) ->
           next = FOREVER;
           next = (seat[A] == waiting && due[A] < next -> due[A] : next);
           next = (seat[B] == waiting && due[B] < next -> due[B] : next);
           if
           :: next >= FOREVER || now == END -> over = true
           :: else ->
              atomic {
                assert(!dead || seat[B] != freed || has_joined);
                assert(is_quiet_world && (seat[A] != running) && (dead || seat[B] != running));
                now = next;
                last = B    /* A comes first again */
              }
           fi
        fi
     fi
  od
}

init {
  atomic {
    run NodeA();
    run NodeB();
    run Worker(0);
    run Worker(1);
    run ReceiveThread();
    run Killer();
    run Run();
    run Timekeeper()
  }
}
