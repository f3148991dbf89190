"""Closings of the gate on steep and gentle slopes: held or lost."""
import sys,time,numpy as np
from footfall.models.policy import stock_policy
from footfall.simulate.learn import stops as S
from footfall.simulate.walker.walkers import Walkers
res={}
class Spy(Walkers):
    def step(self,a,force=None):
        t=super().step(a,force); st=self._state; n=len(st)
        cl=st['closing'].astype(bool)
        if not hasattr(self,'was0'): self.was0=cl.copy(); self.nn=np.zeros(n); self.ll=np.zeros(n)
        stand=self.speed_goal<.2
        self.nn+=(cl&~self.was0&stand); self.ll+=(~cl&self.was0&stand); self.was0=cl.copy(); self.tm=np.where(cl&stand,getattr(self,'tm',np.zeros(n))+.03,0); k=np.abs(self.tm-.75)<.014; res.setdefault('roll',[]).extend(np.abs(np.degrees(st['roll'][k]))); res.setdefault('v',[]).extend(np.abs(st['mean_velocity'][k,1])); res['n']=self.nn; res['l']=self.ll; self.ff=getattr(self,"ff",np.zeros(n,bool))|st['fallen'].astype(bool); res['f']=self.ff
        return t
S.Walkers=Spy
SL=((0.08,0.),(0.,.08),(0.,-.08),(.057,.057),(.057,-.057))

def main(seeds=(31,32,33,34),people=28):
    N=0;L=0;F=0
    for seed in seeds:
        v=S.attempt_stops(stock_policy(),seed=seed,people=people,threads=2,slopes=SL)
        N=N+res['n'].reshape(len(SL),-1).sum(1); L=L+res['l'].reshape(len(SL),-1).sum(1); F=F+res['f'].reshape(len(SL),-1).sum(1)
    print('closings %d lost %s %d fallen %s %d'%(N.sum(),L.astype(int),L.sum(),F,F.sum()),'roll at .75 s p50/90/98',np.round(np.percentile(res['roll'],[50,90,98]),2),'v',np.round(np.percentile(res['v'],[50,90,98]),3),flush=True)
main()
