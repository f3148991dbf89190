import sys,time,numpy as np
from footfall.models.policy import stock_policy
from footfall.simulate.learn import stops as S
from footfall.simulate.walker.walkers import Walkers
class Spy(Walkers):
    def step(self,a,force=None):
        t=super().step(a,force); n=len(self._state)
        if not hasattr(self,'h'): self.h=[]; self.seen=np.zeros(n,bool); self.k=[]
        st=self._state
        self.h.append(np.stack([st['yaw_error'],st['gate'],st['speed'],st['phase'],st['turn'],st['roll'],st['pitch'],st['mean_velocity'][:,0],st['mean_velocity'][:,1],st['closing'].astype(float),st['speed_goal']]).copy())
        for i in np.flatnonzero(st['fallen']&~self.seen):
            H=np.stack([h[:,i] for h in self.h[-130:]])
            kind='ASTRAY' if abs(H[-1,0])>1.1 else 'fall'
            print(i//24,i%24,kind,'step',len(self.h))
            if kind=='ASTRAY':
                for r in H[::6]: print('   yaw %6.1f gate %.2f speed %.2f phase %.2f turn %5.2f roll %5.1f pitch %5.1f v %5.2f %5.2f closing %d goal %.1f'%(np.degrees(r[0]),r[1],r[2],r[3]%1,r[4],np.degrees(r[5]),np.degrees(r[6]),r[7],r[8],r[9],r[10]))
        self.seen|=st['fallen'].astype(bool)
        return t
S.Walkers=Spy
SL=((0.08,0.),(-.08,0.),(0.,.08),(0.,-.08),(.057,.057),(.057,-.057))
for seed in (31,32):
    v=S.attempt_stops(stock_policy(),seed=seed,people=24,threads=2,slopes=SL); print('falls',v.falls,'of',v.stops)
