import sys,time,numpy as np
from footfall.models.policy import stock_policy
from footfall.simulate.learn import stops as S
from footfall.simulate.walker.walkers import Walkers
log=[]
class Spy(Walkers):
    def step(self,a,force=None):
        t=super().step(a,force); n=self.fallen().shape[0]
        if not hasattr(self,'hist'): self.hist=[]; self.told=np.zeros(n); self.seen=np.zeros(n,bool); self.closed=np.full(n,-1.0); self.opened=np.zeros(n)
        stand=self.speed_goal<.2
        self.told=np.where(stand,self.told+self._state['dt'],0)
        cl=self._state['closing'].astype(bool)
        self.closed=np.where(cl&stand,np.where(self.closed<0,self.told,self.closed),np.where(stand,self.closed,-1))
        lost=(~cl)&(self.closed>0)&stand; self.opened+=0
        f=self.fallen(); 
        v=self.velocity()
        self.hist.append((v[0].copy() if isinstance(v,tuple) else v[:,0].copy(), v[1].copy() if isinstance(v,tuple) else v[:,1].copy(), self._state['gate'].copy(), self._state['speed'].copy()))
        for i in np.flatnonzero(f&~self.seen):
            k=max(0,len(self.hist)-25); h=self.hist[k]
            up=self.up[i]
            log.append((i,round(-up[0]/up[2],2),round(-up[1]/up[2],2),round(float(self.told[i]),2),round(float(self.closed[i]),2),round(float(h[0][i]),2),round(float(h[1][i]),2),round(float(self.hist[-1][0][i]),2),round(float(self.hist[-1][1][i]),2),round(float(self.hist[-12][2][i]),2),bool(stand[i])))
        self.seen|=f
        return t
S.Walkers=Spy
SL=((0.08,0.),(0.,.08),(0.,-.08),(.057,.057),(.057,-.057))
tot=0
for seed in (31,32,33):
    v=S.attempt_stops(stock_policy(),seed=seed,people=24,threads=2,slopes=SL); tot+=v.falls
    print('falls',v.falls,'of',v.stops)
    for r in sorted(log,key=lambda r:r[1:3]): print('grade',r[1:3],'told for',r[3],'first closed',r[4],'v 0.75s before (fwd,left)',r[5:7],'at fall',r[7:9],'gate .36s before',r[9],'stand',r[10])
    log.clear()
