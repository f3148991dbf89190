"""Drift of slow steps on side slopes, lost closings, falls."""
import sys,time,numpy as np
from footfall.models.policy import stock_policy
from footfall.simulate.learn import stops as S
from footfall.simulate.walker.walkers import Walkers
R={}
class Spy(Walkers):
    def step(self,a,force=None):
        t=super().step(a,force); st=self._state; n=len(st)
        cl=st['closing'].astype(bool)
        if not hasattr(self,'was0'):
            self.was0=cl.copy(); self.nn=np.zeros(n); self.ll=np.zeros(n); self.ff=np.zeros(n,bool); self.wt=np.zeros(n); self.mx=np.zeros(n); self.go=np.full(n,9.)
            self.D=[[] for _ in range(n)]; self.W=[[] for _ in range(n)]; self.G=[[] for _ in range(n)]; self.X=[[] for _ in range(n)]
            self.fw=[]
        stand=self.speed_goal<.2
        fallen=st['fallen'].astype(bool)
        for i in np.flatnonzero(fallen&~self.ff): self.fw.append((i,'stop' if stand[i] else 'go',round(float(self.go[i]),1),round(float(st['waiting'][i]),1),round(float(st['mean_velocity'][i,0]),2),round(float(st['mean_velocity'][i,1]),2)))
        self.go=np.where(stand,0,self.go+.03)
        self.nn+=(cl&~self.was0&stand); self.ll+=(~cl&self.was0&stand); self.was0=cl.copy()
        self.ff|=fallen
        ok=~self.ff
        slow=stand&(st['gate']>=1)&(st['speed']<.35)&ok
        for i in np.flatnonzero(slow): self.D[i].append(st['mean_velocity'][i,1]); self.X[i].append(st['mean_velocity'][i,0])
        out=~stand&(st['gate']>=1)&(self.go>.3)&(self.go<2)&ok
        for i in np.flatnonzero(out): self.G[i].append(st['mean_velocity'][i,1])
        self.wt+=slow*.03
        R['w']=self
        return t
S.Walkers=Spy
class FakeRng:
    pass
_place=Spy.place
def place(self,mask,**k):
    k['variability']=k['variability']*VAR; return _place(self,mask,**k)
Spy.place=place
VAR=1.5
SL=((0,.08),(0,-.08),(0,.05),(0,-.05),(-.08,0.))
def main(seeds,people,threads):
    A=[[[],[],[],[]] for _ in SL]; N=np.zeros(len(SL));L=N.copy();F=N.copy();fw=[]
    t0=time.time()
    for seed in seeds:
        v=S.attempt_stops(stock_policy(),seed=seed,people=people,threads=threads,slopes=SL); w=R['w']
        N+=w.nn.reshape(len(SL),-1).sum(1);L+=w.ll.reshape(len(SL),-1).sum(1);F+=w.ff.reshape(len(SL),-1).sum(1)
        fw+=[(seed,str(SL[f[0]//people]),*f) for f in w.fw]
        for i in range(len(SL)*people):
            k=i//people; sg=np.sign(SL[k][1]) or 1
            A[k][0]+=[sg*np.mean(w.D[i])] if w.D[i] else []; A[k][1]+=[sg*x for x in w.D[i]]; A[k][2]+=[sg*x for x in w.G[i]]; A[k][3].append(w.wt[i]/2)
    for k,s in enumerate(SL):
        d,g=np.array(A[k][1]),np.array(A[k][2])
        print(s,'closings %d lost %d falls %d'%(N[k],L[k],F[k]),'drift uphill stopping mean %.3f sd %.3f p5 %.3f p95 %.3f; out mean %.3f p5 %.3f p95 %.3f; wait %.2f p90 %.2f'%(d.mean(),d.std(),*np.percentile(d,[5,95]),g.mean(),*np.percentile(g,[5,95]),np.mean(A[k][3]),np.percentile(A[k][3],90)))
    for f in fw: print(f)
    print('TOTAL closings %d lost %d falls %d of %d stops, verdict %s'%(N.sum(),L.sum(),F.sum(),2*people*len(SL)*len(seeds),v),round(time.time()-t0),flush=True)
main([int(x) for x in sys.argv[1].split(',')],int(sys.argv[2]),int(sys.argv[3]))
