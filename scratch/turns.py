import numpy as np, sys
sys.path.insert(0,".")
from tests.simulate.test_setting_out import *
def go(seed, n=24, turn=.9, speed=.8):
    rng=np.random.default_rng(seed); group=stand([Person(draw_subject(rng)) for _ in range(n)]); policy=stock_policy(); out=np.zeros(n,bool); kinds=[]
    def on(sec):
        for _ in range(round(sec/.03)):
            group.step(policy(group.observe())); f=group.fallen()&~out
            for i in np.flatnonzero(f): kinds.append((int(i),round(float(np.degrees(group._state['yaw_error'][i]))),round(float(group._state['height'][i]),2)))
            out[:]|=f
            bad=np.flatnonzero(group.fallen())
    on(1.5); group.speed_goal[:]=speed; on(2.0)
    for t in (turn,-turn):
        group.turn_goal[:]=t*np.array([1,-1]*(n//2)); on(3.0)
    return int(out.sum()),kinds
for seed in (7,8,9): print(seed,go(seed))
